#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Prints a line for every test that CTest skipped: its name, the reason, and what lets it run, as the test printed them.

usage: list_skipped.py OUTPUT LOG; what ctest printed, and its Testing/Temporary/LastTest.log
"""

import re
import sys
from pathlib import Path

# Programs of our own (tests/support/skipping.py), GoogleTest, pytest -rs.
REASONS = re.compile(r"^skipped: (.+)$|: Skipped\n+(.+)$|^SKIPPED \[\d+\] .*?\.py(?::\d+)?: (.+)$", re.MULTILINE)
MISSING_MODULE = re.compile(r"could not import|No module named")


def skipped_names(output):
    return re.findall(r"^\s*\d+ - (.+) \(Skipped\)$", output, re.MULTILINE)


def outputs(log):
    """What every test printed, by its name."""
    blocks = re.findall(r"^\d+/\d+ Testing: ([^\n]+)$.*?^Output:\n-+\n(.*?)^<end of output>$", log, re.MULTILINE | re.DOTALL)
    return dict(blocks)


def reason_in(output):
    found = REASONS.search(output)
    if found is None:
        return "no reason given; run it alone: ./dev test -V -R NAME"
    reason = next(group for group in found.groups() if group)
    if MISSING_MODULE.search(reason) and ";" not in reason:
        reason += "; ./dev test installs it, with apt-get or from PyPI"
    return reason


def main():
    output, log = (Path(path).read_text(encoding="utf-8", errors="replace") for path in sys.argv[1:])
    printed = outputs(log)
    for name in skipped_names(output):
        print(f"skipped: {name}: {reason_in(printed.get(name, ''))}")


if __name__ == "__main__":
    main()
