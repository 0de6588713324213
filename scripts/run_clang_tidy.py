#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs clang-tidy over the project's own sources, in parallel.

usage: run_clang_tidy.py BUILD_FOLDER JOBS [COMMIT]; exit status 1 when it finds something.
With a COMMIT, only sources are checked that differ from it, these first, or include, also indirectly, a file that does.
All are checked if the repository lacks the commit.
It uses the clang-tidy that ./dev installs from PyPI, because it skips the headers of others, in which older versions
spend most of the time; without that package, the one in PATH. Reading these headers still takes time, so several sources
that are compiled alike are checked as one. Sources that do not go together, because they define the same name, are in
other groups; a group with a finding is split until the source is known. A source that passed is not checked again, in any
clone, until it, a header of the project that it includes, its options or the configuration changes: the folder
glidar-tidy in the user's cache keeps one empty file per hash of them.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from affected_sources import affected, changed_since, with_includes
from source_groups import groups

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("glidar", "apps", "bench", "examples", "python", "tests")
GROUP_SIZE = 16
PACKAGED = ROOT / "build/venv-lint/bin/clang-tidy"
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "glidar-tidy"
CLANG_TIDY = str(PACKAGED) if PACKAGED.exists() else "clang-tidy"


def own_sources(build):
    """(file, folder that it is compiled in, compile command) of every source of the project."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    sources = {}
    for entry in entries:
        file = Path(entry["file"])
        if file.is_relative_to(ROOT) and file.relative_to(ROOT).parts[0] in FOLDERS:
            sources[file] = (entry["directory"], entry["command"])
    return [(file, *sources[file]) for file in sorted(sources)]


def flags_of(file, command):
    """The compile command without what belongs to the one file."""
    return re.sub(r" -o \S+ -c \S+$| -o \S+", "", command.replace(str(file), "FILE"))


def groups_of(sources, size=GROUP_SIZE):
    """Sources of a layer with the same flags, at most `size` together, none of which define the same names."""
    return groups(sources, size, lambda source: (source[0].relative_to(ROOT).parts[:-1][:2], source[1],
                                                 flags_of(source[0], source[2])))


def stamps_of(sources):
    """For every source, the file that states that it passed with all that its check depends on."""
    version = subprocess.run([CLANG_TIDY, "--version"], capture_output=True, check=True).stdout
    settings = [ROOT / ".clang-tidy", ROOT / "tests/.clang-tidy", Path(__file__)]
    shared = version + b"".join(file.read_bytes() for file in settings if file.exists())
    includes, texts, stamps = {}, {}, {}
    for file, _, command in sources:
        digest = hashlib.sha256(shared + command.replace(str(ROOT), "").encode())
        for path in sorted(with_includes(ROOT, file, includes)):
            if path not in texts:
                texts[path] = str(path.relative_to(ROOT)).encode() + path.read_bytes()
            digest.update(texts[path])
        stamps[file] = CACHE / digest.hexdigest()
    return stamps


def run(database, file, *options):
    """(exit status, output) of clang-tidy."""
    # -w: what the compiler may warn of is decided by the compiler of the build
    command = [CLANG_TIDY, "-p", str(database), "--quiet", "--warnings-as-errors=*", "--extra-arg=-w", *options]
    done = subprocess.run([*command, str(file)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + (done.stderr if "error:" not in done.stdout else "")


def findings(build, members, stamps):
    """The findings of clang-tidy for a group of files: of its halves, if it does not pass as a whole. Some may not compile
    together, and findings are clearest for a single file. Files that pass get their stamps."""
    if len(members) == 1:
        status, text = run(build, members[0][0])
        passed = status == 0
    else:
        passed = check_together(build, members)
    if passed:
        for file, _, _ in members:
            stamps[file].touch()
        return ""
    if len(members) == 1:
        return text
    half = len(members) // 2
    return findings(build, members[:half], stamps) + findings(build, members[half:], stamps)


def check_together(build, members):
    """Whether a source that includes all files passes."""
    first, directory, command = members[0]
    # below a folder with the settings of the tests, if they are tests
    top = first.relative_to(ROOT).parts[0]
    (build / "tidy" / top).mkdir(parents=True, exist_ok=True)
    settings = ROOT / top / ".clang-tidy"
    with tempfile.TemporaryDirectory(dir=build / "tidy" / top) as name:
        folder = Path(name)
        if settings.exists():
            shutil.copy(settings, folder / ".clang-tidy")
        whole = folder / "group.cpp"
        whole.write_text("".join(f'#include "{file}"\n' for file, _, _ in members), encoding="utf-8")
        entry = {"directory": directory, "command": command.replace(str(first), str(whole)), "file": str(whole)}
        (folder / "compile_commands.json").write_text(json.dumps([entry]), encoding="utf-8")
        sources = r"--header-filter=(glidar|apps|bench|examples|python|tests)/.*\.[ch]pp$"
        status, _ = run(folder, whole, sources, "--checks=-bugprone-suspicious-include")
    return status == 0


def main():
    build, jobs = Path(sys.argv[1]).resolve(), int(sys.argv[2])
    sources = own_sources(build)
    changed = changed_since(ROOT, sys.argv[3]) if len(sys.argv) > 3 else None
    if changed is not None:
        wanted = affected(ROOT, {file for file, _, _ in sources}, changed)
        sources = [source for source in sources if source[0] in wanted]
    CACHE.mkdir(parents=True, exist_ok=True)
    stamps = stamps_of(sources)
    waiting = [source for source in sources if not stamps[source[0]].exists()]
    first = [source for source in waiting if str(source[0].relative_to(ROOT)) in (changed or ())]
    others = [source for source in waiting if source not in first]
    with ThreadPoolExecutor(jobs) as pool:
        complaints = 0
        for text in pool.map(lambda members: findings(build, members, stamps), groups_of(first) + groups_of(others)):
            print(text, end="", flush=True)
            complaints += bool(text)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
