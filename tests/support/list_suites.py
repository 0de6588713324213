#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Lists the suites of a GoogleTest program as CTest tests, because a process per case costs more time than most cases.
A failure names its case; a suite is skipped if all its cases are.

usage: list_suites.py PROGRAM PREFIX OUTPUT [SUITE...]; the cases of these suites are CTest tests of their own, because
they measure or limit what belongs to the process.
"""

import re
import subprocess
import sys
from pathlib import Path

# The end of the output when nothing passed and nothing failed.
SKIPPED = r"\[  PASSED  \] 0 tests\.\n(\[  SKIPPED \][^[]*)+$"


def suites_of(listed):
    """The names of all suites and their cases, from the output of --gtest_list_tests."""
    suites = {}
    for line in listed.splitlines():
        name = line.split("#")[0].strip()
        if line.startswith("  "):
            cases.append(name)
        elif name.endswith("."):
            cases = suites.setdefault(name[:-1], [])
    return suites


def unprinted(listed):
    """The names of cases whose parameter is printed as its bytes or its address, which change in every run."""
    return [line.split()[0] for line in listed.splitlines() if re.search(r"# GetParam\(\) = (\d+-byte object <|0x)", line)]


def filters_of(suites, separate):
    """(name, --gtest_filter) of every CTest test."""
    for suite, cases in suites.items():
        if re.sub(r"^\w+/|/\d+$", "", suite) in separate:
            yield from ((f"{suite}.{case}", f"{suite}.{case}") for case in cases)
        else:
            yield suite, f"{suite}.*"


def main():
    program, prefix, output, *separate = sys.argv[1:]
    listed = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    if unprinted(listed):
        sys.exit(f"{program}: parameters without a PrintTo: {', '.join(unprinted(listed))}")
    lines = []
    for name, chosen in filters_of(suites_of(listed), separate):
        lines.append(f"add_test([==[{prefix}: {name}]==] [==[{program}]==] [==[--gtest_filter={chosen}]==])\n"
                     f"set_tests_properties([==[{prefix}: {name}]==] PROPERTIES SKIP_REGULAR_EXPRESSION [==[{SKIPPED}]==])\n")
    Path(output).write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
