#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how much there is to know: lines, files, types, headers and words of the tracked files, beside their goals.

usage: measure_weight.py [--headers]; --headers lists the headers with one user
"""

import os
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PRODUCT = ("glidar/", "apps/", "python/")
CODE = (".cpp", ".hpp", ".py", ".glsl")
INCLUDE = re.compile(r'^#include [<"]([^>"]+)[>"]', re.M)
TYPE = re.compile(r"^\s*(?:struct|class|enum(?: class)?|union) \w[^;=()]*\{", re.M)


def tracked():
    """The text of every tracked file that is text, by its path."""
    texts = {}
    for name in subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True).split("\0"):
        path = ROOT / name
        if name and path.is_file():
            texts[name] = path.read_text(encoding="utf-8", errors="replace")
    return texts


def users_of(texts):
    """Which sources of the product include each of its headers, apart from the .cpp of the same name."""
    sources = {name: text for name, text in texts.items() if name.startswith(PRODUCT) and name.endswith((".cpp", ".hpp"))}
    users = defaultdict(set)
    for name, text in sources.items():
        for included in INCLUDE.findall(text):
            for header in (included, os.path.join(os.path.dirname(name), included)):
                if header in sources and header != name[:-3] + "hpp":
                    users[header].add(name)
    return {name: users[name] for name in sources if name.endswith(".hpp")}


def lone_headers(texts):
    """Private headers with exactly one user, and that user."""
    public = set(texts["glidar/public_headers.txt"].split())
    return {header: next(iter(users)) for header, users in users_of(texts).items()
            if len(users) == 1 and header not in public}


def measures(texts):
    """Rows of (what, value, goal)."""
    product = {name: text.count("\n") for name, text in texts.items() if name.startswith(PRODUCT) and name.endswith(CODE)}
    library = [name for name in product if name.startswith("glidar/") and name.endswith((".cpp", ".hpp"))]
    lines = sum(product[name] for name in library)
    types = sum(len(TYPE.findall(texts[name])) for name in library)
    words = sum(len(text.split()) for name, text in texts.items() if name.startswith("docs/") and name.endswith(".md"))
    return [("product lines", sum(product.values()), "105,000 or less"),
            ("tracked files", len(texts), "1,700 or less"),
            ("lines per library file", round(lines / len(library)), "200 or more"),
            ("types per 1,000 library lines", round(1000 * types / lines, 1), "9 or less"),
            ("private headers with one user", len(lone_headers(texts)), "40 or less"),
            ("words in docs/", words, "45,000 or less")]


def main(arguments):
    texts = tracked()
    if arguments == ["--headers"]:
        for header, user in sorted(lone_headers(texts).items()):
            print(f"{header}: {user}")
    elif arguments:
        sys.exit(__doc__)
    else:
        for what, value, goal in measures(texts):
            print(f"{what}: {value:,} (goal: {goal})")


if __name__ == "__main__":
    main(sys.argv[1:])
