#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks programs and shared libraries: where they look for libraries, and how they are hardened.

usage: check_binaries.py [--search-path-only] FOLDER...; exit status 1 when something is wrong.
The search path must not depend on the current folder. GLIDAR's own files must also be position-independent,
bound before they run with read-only relocations, without executable stack, and compiled with the stack
protector, checked copies and, on x86-64, marked targets of indirect jumps (cmake/hardening.cmake).
"""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

OWN = re.compile(r"(glidar|libglidar|_core)[^/]*$")
X86_64 = 62  # e_machine of an ELF file
ENDBR64 = b"\xf3\x0f\x1e\xfa"  # marks where indirect jumps may lead (Intel CET)
FEWEST_MARKS = 8  # the startup code of some systems has a few; each function of ours that may be called so has one
NOT_SHIPPED = re.compile(r"_(tests|bench|baseline|driver)$|glidar_(example|fuzz|io_files|sandbox_probe|without_sandbox)")


def elf_files(folder):
    """Programs and shared libraries below a folder; object files and links are left out."""
    for path in sorted(Path(folder).rglob("*")):
        if path.is_symlink() or not path.is_file() or path.suffix in (".o", ".a"):
            continue
        with open(path, "rb") as file:
            head = file.read(18)
        if head[:4] == b"\x7fELF" and head[16] in (2, 3):  # ET_EXEC, ET_DYN
            yield path


def readelf(*arguments):
    environment = {**os.environ, "LC_ALL": "C"}
    done = subprocess.run(["readelf", "-W", *arguments], capture_output=True, text=True, check=True, env=environment)
    return done.stdout


def search_path_problems(dynamic):
    """What is wrong with RUNPATH and RPATH, given the output of `readelf -d`."""
    for entries in re.findall(r"\((?:RUNPATH|RPATH)\).*\[(.*)\]", dynamic):
        for entry in sorted(set(entries.split(":"))):
            if entry == "":
                yield f"the search path for libraries '{entries}' has an empty entry: the current folder"
            elif not re.match(r"/|\$ORIGIN(/|$)", entry):
                yield f"the search path for libraries '{entries}' has the relative entry '{entry}'"


def hardening_problems(dynamic, segments, symbols):
    """What hardening is missing, given the output of `readelf -d`, `-lh` and `--dyn-syms`."""
    if not re.search(r"Type:\s+DYN", segments):
        yield "it is not position-independent"
    if not re.search(r"BIND_NOW|Flags:.*NOW", dynamic) or "GNU_RELRO" not in segments:
        yield "its relocations are not read-only (-z relro -z now)"
    if re.search(r"GNU_STACK.*RWE", segments):
        yield "its stack is executable"
    if "__stack_chk_fail" not in symbols:
        yield "it has no stack protector"
    if not re.search(r"__\w+_chk\b", symbols.replace("__stack_chk_fail", "")):
        yield "copies are not checked (_FORTIFY_SOURCE)"


def jump_target_problems(content):
    """Errors in the marks of jump targets. The note that a whole program has them is not required:
    the startup code of Debian 12 has none, so no program there gets it."""
    machine = int.from_bytes(content[18:20], "little")
    if machine == X86_64 and content.count(ENDBR64) < FEWEST_MARKS:
        yield "targets of indirect jumps are not marked (-fcf-protection)"


def problems(path, search_path_only=False):
    """All that is wrong with one file, in words."""
    dynamic = readelf("-d", path)
    found = list(search_path_problems(dynamic))
    if not search_path_only and OWN.match(path.name) and not NOT_SHIPPED.search(path.name):
        found += hardening_problems(dynamic, readelf("-lh", path), readelf("--dyn-syms", path))
        found += jump_target_problems(Path(path).read_bytes())
    return found


def check(folders, search_path_only=False):
    """(number of files, complaints) for folders."""
    count, complaints = 0, []
    for folder in folders:
        for path in elf_files(folder):
            count += 1
            complaints += [f"{path}: {problem}" for problem in problems(path, search_path_only)]
    return count, complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--search-path-only", action="store_true", help="do not look for hardening")
    parser.add_argument("folders", nargs="+", metavar="FOLDER")
    options = parser.parse_args()
    count, complaints = check(options.folders, options.search_path_only)
    if count == 0:
        complaints.append(f"{' '.join(options.folders)}: no program or library")
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
