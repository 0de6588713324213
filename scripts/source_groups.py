#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Groups C++ sources that can be compiled together, because none of them define or shadow the others' names.

usage: source_groups.py SIZE FILE...; prints a line per group: its files, separated by semicolons.
A group has at most SIZE sources.
"""

import re
import sys
from pathlib import Path

# Constants and types by name, functions by the line that they begin with; those of unnamed namespaces by name, because
# one overload may take the calls of another.
DEFINITIONS = re.compile(
    r"^(?:(?:static |inline )*const(?:expr|init)? [^(={;\n]*?(\w+)(?:\[\w*\])? ?[={;]|(?:struct|class|enum class) (\w+)|using (\w+) ="
    r"|(\w[^;=\n]* [&*]?\w+\([^;\n]*[{,]$))", re.MULTILINE)
HIDDEN = re.compile(r"^namespace \{$.*?^\}  // namespace$", re.MULTILINE | re.DOTALL)
# Constants and names of types in functions; in another source of the group they must not shadow a definition.
LOCALS = re.compile(r"^\s+(?:(?:static )?const(?:expr)? [^(={;\n]*?(\w+)(?:\[\w*\])? ?[={]|using (\w+) =)", re.MULTILINE)


def signature(line):
    """A function's first line without the names of its parameters."""
    name, _, parameters = line.partition("(")
    if name == "int main":
        return "main"
    types = [re.sub(r"(?<=[&*\s])\w+$", "", part.strip(" {)")) for part in parameters.split(",")]
    return f"{name.split()[-1]}({','.join(kind.replace(' ', '') for kind in types)}"


def definitions(text):
    """The names that a source defines at namespace scope."""
    found = DEFINITIONS.findall(text)
    hidden = [function for *_, function in DEFINITIONS.findall("".join(HIDDEN.findall(text))) if function]
    return {next(filter(None, names)) for *names, _ in found if any(names)} - {"namespace"} | {
        signature(function) for *_, function in found if function} | {signature(function).split("(")[0] for function in hidden}


def groups(sources, size, kind_of):
    """Sources of equal kind, at most `size` together, none of which define the same names. Each source is a tuple
    that begins with its path."""
    found = []
    for source in sources:
        kind, text = kind_of(source), source[0].read_text(encoding="utf-8")
        names, constants = definitions(text), {first or second for first, second in LOCALS.findall(text)}
        for other_kind, members, taken, shadowing in found:
            if other_kind == kind and len(members) < size and not (names & (taken | shadowing) or constants & taken):
                members.append(source)
                taken |= names
                shadowing |= constants
                break
        else:
            found.append((kind, [source], names, constants))
    return [members for _, members, *_ in found]


def main():
    sources = [(Path(name),) for name in sys.argv[2:]]
    for members in groups(sources, int(sys.argv[1]), lambda source: None):
        print(";".join(str(file) for file, in members))


if __name__ == "__main__":
    main()
