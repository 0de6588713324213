#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Groups C++ sources that can be compiled together, because none of them define the same names.

usage: source_groups.py SIZE FILE...; prints a line per group: its files, separated by semicolons.
Sources of one group are in the same folder. A group has at most SIZE sources.
"""

import re
import sys
from pathlib import Path

# Constants and types by name, functions by the line that they begin with.
DEFINITIONS = re.compile(
    r"^(?:(?:static |inline )*const(?:expr|init)? [^(={;\n]*?(\w+)(?:\[\w*\])? ?[={;]|(?:struct|class|enum class) (\w+)|using (\w+) ="
    r"|(\w[^;=\n]* [&*]?\w+\([^;\n]*[{,]$))", re.MULTILINE)


def definitions(text):
    """The names that a source defines at namespace scope."""
    return {next(filter(None, found)) for found in DEFINITIONS.findall(text)} - {"namespace"}


def groups(sources, size, kind_of):
    """Sources of equal kind, at most `size` together, none of which define the same names. Each source is a tuple
    that begins with its path."""
    found = []
    for source in sources:
        kind, names = kind_of(source), definitions(source[0].read_text(encoding="utf-8"))
        for other_kind, members, taken in found:
            if other_kind == kind and len(members) < size and not names & taken:
                members.append(source)
                taken |= names
                break
        else:
            found.append((kind, [source], names))
    return [members for _, members, _ in found]


def main():
    sources = [(Path(name),) for name in sys.argv[2:]]
    for members in groups(sources, int(sys.argv[1]), lambda source: source[0].parent):
        print(";".join(str(file) for file, in members))


if __name__ == "__main__":
    main()
