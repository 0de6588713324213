#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Finds the C++ sources that a change affects: those that changed or include, also indirectly, a file that did."""

import re
import subprocess
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.MULTILINE)
# A change of one of these may change the findings of any source.
SETTINGS = re.compile(r"(^|/)\.clang-tidy$")


def changed_since(root, commit):
    """Paths of the files that differ from a commit or are new; None if the repository lacks the commit."""
    def git(*arguments):
        return subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=False)

    difference = git("diff", "--name-only", "-z", commit, "--")
    if difference.returncode != 0:
        return None
    new = git("ls-files", "--others", "--exclude-standard", "-z")
    return {name for name in (difference.stdout + new.stdout).split("\0") if name}


def included_by(root, file):
    """The project's files that a file includes itself."""
    found = set()
    for name in INCLUDE.findall(file.read_text(encoding="utf-8", errors="replace")):
        top = file.relative_to(root).parts[0]
        for folder in (root, file.parent, root / top):
            path = folder / name
            if path.is_file():
                found.add(path.resolve())
                break
    return found


def with_includes(root, source, includes):
    """A source and the project's files that it includes, also indirectly. `includes` keeps what was read."""
    seen, waiting = {source}, [source]
    while waiting:
        file = waiting.pop()
        if file not in includes:
            includes[file] = included_by(root, file)
        new = includes[file] - seen
        seen |= new
        waiting += new
    return seen


def affected(root, sources, changed):
    """The paths among `sources` that the changed files, named relative to `root`, affect."""
    if any(SETTINGS.search(name) for name in changed):
        return set(sources)
    changed, includes = {root / name for name in changed}, {}
    return {source for source in sources if changed & with_includes(root, source, includes)}
