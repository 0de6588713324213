#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks every tracked source file: licence head, length; that no test sleeps; and that the product calls no function
whose bits differ between machines.

usage: check_files.py; exit status 1 when a file breaks a rule.
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
COPYRIGHT = "SPDX-FileCopyrightText: 2026 The GLIDAR developers"
SOURCES = {".cpp", ".hpp", ".py", ".sh", ".cmake", ".glsl"}
NAMES = {"dev", "run", "CMakeLists.txt"}
MAX_LINES = 800
TABLES = set()  # files that are long because they hold data, one path each
SLEEP = re.compile(r"\b[nu]?(nano)?sleep(_for|_until)?\b")
# Tests wait for conditions (CONTRIBUTING.md); these files may name a sleep, each for its reason.
SLEEPERS = {
    "tests/support/waiting.py": "the helper that waits",
    "tests/support/waiting.hpp": "the helper that waits",
    "tests/python/errors_test.py": "a program that hangs, which the test interrupts",
    "tests/io/decoder/decoder_process_test.cpp": "programs that hang, which the library ends",
    "tests/io/model/import_process_test.cpp": "programs that hang, which the library ends",
    "tests/scripts/check_files_test.py": "the test of this rule",
}
# Functions of the C library that are not exactly defined, also where Eigen calls them, and long double: their bits differ
# between libraries, their versions and processors. glidar/math has its own.
ELEMENTARY = ("a?(?:sin|cos|tan)h?|atan2|sincos|exp|exp2|exp10|expm1|pow|cbrt|hypot|erfc?|[lt]gamma|"
              "log2|log10|log1p")
NOT_PORTABLE = re.compile(
    rf"\bstd::(?:{ELEMENTARY}|log|polar)[fl]?\s*\(|(?<![\w:.>~])(?:::)?(?:{ELEMENTARY})[fl]?\(|\blong double\b|"
    r"\bEigen::(?:AngleAxis|Rotation2D)|[.>](?:slerp|angularDistance|eulerAngles|canonicalEulerAngles|"
    r"sin|cos|tan|exp|log|pow)\(")
CODE_ELSE = re.compile(r'"(?:\\.|[^"\\])*"|//.*')  # strings and comments
PORTABLE_FOLDERS = ("glidar/", "apps/", "python/src/")
NOT_ON_THE_DATA_PATH = ("glidar/verify/",)  # closed forms, which share nothing with what they check

# Everything that is printed is made printable in one place, because texts may be from files.
PRINTS = {".cpp": re.compile(r"\bfmt::print(?:ln)?\b|\bstd::(?:cout|cerr|clog|print(?:ln)?)\b|"
                             r"(?<![\w.>])(?:std::)?(?:f?printf|f?puts|f?putc|putchar|fwrite|perror)\("),
          ".py": re.compile(r"(?<![\w.])print\(|\bsys\.(?:__)?std(?:err|out)(?:__)?\.write")}
PRINTERS = {
    "apps/glidar/run/console.cpp": "makes lines printable, draws the progress display",
    "python/glidar/_printing.py": "makes lines printable",
}


def must_not_print(path):
    """True where the rule holds."""
    return path.startswith((*PORTABLE_FOLDERS, "python/glidar/")) and path not in PRINTERS


def must_be_portable(path):
    """True where the rule holds."""
    return (path.startswith(PORTABLE_FOLDERS) and path.endswith((".cpp", ".hpp"))
            and not path.startswith(("glidar/math/", *NOT_ON_THE_DATA_PATH)))


def is_source(path):
    return path.suffix in SOURCES or path.name in NAMES


def check_text(path, text):
    """All complaints about a file's text."""
    lines = text.splitlines()
    complaints = []
    head = "\n".join(lines[:4])
    if COPYRIGHT not in head or LICENCE not in head:
        complaints.append(f"{path}:1: the two SPDX lines are missing at the top")
    if len(lines) > MAX_LINES and path not in TABLES:
        complaints.append(f"{path}:{MAX_LINES}: {len(lines)} lines, allowed are {MAX_LINES}; split it")
    if path.startswith("tests/") and path not in SLEEPERS:
        complaints += [f"{path}:{number}: a test sleeps; wait for a condition with tests/support/waiting.py or .hpp"
                       for number, line in enumerate(lines, 1) if SLEEP.search(line)]
    if must_be_portable(path):
        for number, line in enumerate(lines, 1):
            if found := NOT_PORTABLE.search(CODE_ELSE.sub("", line)):
                complaints.append(f"{path}:{number}: '{found[0].strip('.>(')}' has other bits on other machines; "
                                  "use glidar/math/portable.hpp, elementary.hpp or double_double.hpp")
    if must_not_print(path):
        prints = PRINTS.get(Path(path).suffix.replace(".hpp", ".cpp"))
        complaints += [f"{path}:{number}: prints; use apps/glidar/run/console.hpp or python/glidar/_printing.py"
                       for number, line in enumerate(lines, 1)
                       if prints and prints.search(CODE_ELSE.sub("", line) if path.endswith("pp") else line)]
    return complaints


def main():
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    complaints = []
    for path in filter(None, listed.split("\0")):
        if is_source(Path(path)) and (ROOT / path).is_file():
            complaints += check_text(path, (ROOT / path).read_text(encoding="utf-8"))
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
