#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The promises of SECURITY.md: each names tests that exist."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASE = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)


def promises(text):
    """{promise: names of its tests} of the table."""
    table = text.split("## Promises")[1].split("\n## ")[0]
    rows = [line.strip("|").split("|") for line in table.splitlines() if line.startswith("|")][2:]
    return {promise.strip(): re.findall(r"`([^`]+)`", tests) for promise, tests in rows}


def cpp_cases():
    """Suite.Case of all tests in C++."""
    return {f"{suite}.{case}" for path in (ROOT / "tests").rglob("*_test.cpp")
            for suite, case in CASE.findall(path.read_text(encoding="utf-8"))}


def is_python_test(name):
    """Whether `tests/FILE.py::test_name` exists."""
    file, _, function = name.partition("::")
    path = ROOT / file
    return path.is_file() and re.search(rf"^\s*def {function}\(", path.read_text(encoding="utf-8"), re.MULTILINE) is not None


class Promises(unittest.TestCase):
    def test_every_promise_names_tests_that_exist(self):
        cases = cpp_cases()
        found = promises((ROOT / "SECURITY.md").read_text(encoding="utf-8"))
        self.assertGreater(len(found), 5)
        for promise, tests in found.items():
            self.assertTrue(tests, promise)
            for name in tests:
                exists = is_python_test(name) if "::" in name else name in cases
                self.assertTrue(exists, f"{promise}: {name}")

    def test_missing_tests_are_found(self):
        self.assertEqual(promises("## Promises\n\n| promise | tests |\n|---|---|\n| No. | `A.B`, `c.py::test_d` |\n\n## Next\n"),
                         {"No.": ["A.B", "c.py::test_d"]})
        self.assertFalse(is_python_test("tests/scripts/security_test.py::test_no_such"))
        self.assertFalse(is_python_test("tests/no_such_test.py::test_missing_tests_are_found"))
        self.assertTrue(is_python_test("tests/scripts/security_test.py::test_missing_tests_are_found"))


if __name__ == "__main__":
    unittest.main()
