#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs clang-tidy over the project's own sources, in parallel.

usage: run_clang_tidy.py BUILD_FOLDER JOBS; exit status 1 when it finds something.
A file that passed is not checked again until it, a header of the project or the configuration
changes: BUILD_FOLDER/tidy keeps one empty file per hash of them.
"""

import hashlib
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("glidar", "apps", "bench", "examples", "python", "tests")


def own_sources(build):
    """(file, compile command) of every source of the project in the compilation database."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    sources = {}
    for entry in entries:
        file = Path(entry["file"])
        if file.is_relative_to(ROOT) and file.relative_to(ROOT).parts[0] in FOLDERS:
            sources[file] = entry["command"]
    return sorted(sources.items())


def hash_of_shared():
    """The hash of all that any check depends on: the configuration and the project's headers."""
    digest = hashlib.sha256()
    files = list(ROOT.glob(".clang-tidy")) + list(ROOT.glob("tests/.clang-tidy"))
    for folder in FOLDERS:
        files += (ROOT / folder).rglob("*.hpp")
    for file in sorted(files):
        digest.update(str(file.relative_to(ROOT)).encode() + file.read_bytes())
    return digest.digest()


def check(build, file, stamp):
    """What clang-tidy says of the file; "" if nothing. Leaves the stamp then."""
    # -w: what the compiler may warn of is decided by the compiler of the build
    command = ["clang-tidy", "-p", str(build), "--quiet", "--warnings-as-errors=*", "--extra-arg=-w"]
    command.append(str(file))
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        stamp.touch()
        return ""
    return done.stdout + (done.stderr if "error:" not in done.stdout else "")


def main():
    build, jobs = Path(sys.argv[1]).resolve(), int(sys.argv[2])
    (build / "tidy").mkdir(exist_ok=True)
    shared = hash_of_shared()
    waiting = []
    for file, command in own_sources(build):
        key = hashlib.sha256(shared + command.encode() + file.read_bytes()).hexdigest()
        stamp = build / "tidy" / key
        if not stamp.exists():
            waiting.append((file, stamp))
    with ThreadPoolExecutor(jobs) as pool:
        complaints = 0
        for text in pool.map(lambda item: check(build, *item), waiting):
            print(text, end="", flush=True)
            complaints += bool(text)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
