#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that the layers include each other in one direction only (docs/internals/architecture.md).

usage: check_includes.py [ROOT]; exit status 1 when a file breaks a rule.
"""

import re
import sys
from pathlib import Path

# Which layers the files of a layer may include. Folders that are not named (apps, tests, bench,
# examples) may include any.
ALLOWED = {
    "glidar": {"core", "depth_camera", "sensor", "motion", "render", "simulate", "verify", "explain", "io", "output"},
    "math": {"math"},
    "core": {"math", "core"},
    "sensor": {"math", "core", "depth_camera", "sensor"},
    "depth_camera": {"math", "core", "depth_camera", "sensor"},
    "motion": {"math", "core", "motion"},
    "render": {"math", "core", "render"},
    "simulate": {"math", "core", "depth_camera", "sensor", "motion", "render", "simulate"},
    "verify": {"math", "core", "sensor", "motion", "render", "simulate", "verify"},
    "explain": {"math", "core", "depth_camera", "sensor", "motion", "render", "simulate", "io", "explain"},
    "io": {"math", "core", "depth_camera", "sensor", "motion", "io"},
    "output": {"math", "core", "depth_camera", "sensor", "motion", "simulate", "io", "link", "output"},
    "link": {"math", "core", "io", "link"},
    "woods2016": {"math", "core", "sensor", "motion", "render", "simulate", "link", "woods2016"},
}
PUBLIC_LIST = "glidar/public_headers.txt"
UMBRELLA = "glidar/glidar.hpp"
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer_of(path):
    """The layer of "glidar/core/pose.hpp" is "core", that of "glidar/simulate/simulate.hpp" "simulate"."""
    parts = Path(path).parts
    if len(parts) < 2 or parts[0] != "glidar":
        return None
    return Path(parts[1]).stem


def includes_of(file):
    """Yields (line number, bracket, target) of every include of the file."""
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found[1], found[2]


def read_public_headers(root):
    lines = (root / PUBLIC_LIST).read_text(encoding="utf-8").splitlines()
    return {line.strip() for line in lines if line.strip() and not line.startswith("#")}


def included_by(root, path):
    """The project's headers that a file includes, themselves or through others, and the file."""
    found, open_files = set(), [path]
    while open_files:
        file = open_files.pop()
        if file not in found and (root / file).is_file():
            found.add(file)
            open_files += [target for _, _, target in includes_of(root / file) if layer_of(target)]
    return found


def check_direction(path, target):
    layer, used = layer_of(path), layer_of(target)
    if layer is None or used is None:
        return None
    if layer not in ALLOWED:
        return f"layer {layer} is not known; add it to ALLOWED in scripts/check_includes.py"
    if used not in ALLOWED[layer]:
        return f"{layer} must not include {used} (allowed: {', '.join(sorted(ALLOWED[layer]))})"
    return None


def check_public(target, public):
    """A public header includes public headers, Eigen and the standard library."""
    if layer_of(target) is not None:
        if target not in public:
            return f"a public header includes {target}, which is not in {PUBLIC_LIST}"
        return None
    if target.startswith("Eigen/") or re.fullmatch(r"[a-z_0-9]+", target):
        return None
    return f"a public header includes <{target}>; only Eigen and the standard library are allowed"


def check_include(root, path, include, public):
    _, bracket, target = include
    if layer_of(path) is not None and bracket == '"':
        return f'"{target}" must be included as <glidar/LAYER/FILE.hpp>'
    if layer_of(target) is not None and not (root / target).is_file():
        return f"<{target}> does not exist"
    complaint = check_direction(path, target)
    if complaint is None and path in public:
        complaint = check_public(target, public)
    return complaint


def check_own_header(root, path, includes):
    """NAME.cpp that has a NAME.hpp includes it first, which proves that it is self-contained."""
    own = str(Path(path).with_suffix(".hpp"))
    if not path.endswith(".cpp") or layer_of(path) is None or not (root / own).is_file():
        return None
    if not includes or includes[0][2] != own:
        return f"the first include must be <{own}>"
    return None


def check_file(root, path, public):
    """All complaints about one file, as "path:line: text"."""
    file = root / path
    includes = list(includes_of(file))
    complaints = []
    if path.endswith(".hpp") and "#pragma once" not in file.read_text(encoding="utf-8").split("\n"):
        complaints.append(f"{path}:1: #pragma once is missing")
    own = check_own_header(root, path, includes)
    if own:
        complaints.append(f"{path}:{includes[0][0] if includes else 1}: {own}")
    for include in includes:
        text = check_include(root, path, include, public)
        if text:
            complaints.append(f"{path}:{include[0]}: {text}")
    return complaints


def check_tree(root):
    """All complaints about all C++ files of glidar, apps, bench, examples and tests."""
    public = read_public_headers(root)
    complaints = [
        f"{PUBLIC_LIST}:1: {header} does not exist"
        for header in sorted(public)
        if not (root / header).is_file()
    ]
    complaints += [f"{PUBLIC_LIST}:1: {header} is not included by {UMBRELLA}"
                   for header in sorted(public - included_by(root, UMBRELLA)) if (root / header).is_file()]
    for folder in ("glidar", "apps", "bench", "examples", "python", "tests"):
        for file in sorted((root / folder).rglob("*.[ch]pp")):
            complaints += check_file(root, file.relative_to(root).as_posix(), public)
    return complaints


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    complaints = check_tree(root)
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
