#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""tests/support/list_suites.py: every case of a GoogleTest program runs in one CTest test, and skips hide no failure."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[1] / "support" / "list_suites.py"
sys.path.insert(0, str(SCRIPT.parent))
import list_suites  # noqa: E402

LISTED = """Running main() from gtest_main.cc
Pose.
  IsRigid
  Turns
All/Suite.
  Equals/rays  # GetParam() = "rays"
  Equals/raster  # GetParam() = "a. b"
Typed/0.  # TypeParam = float
  Holds
Leak.
  OfMemory
  OfFiles
"""
SUMMARY = "[==========] 3 tests from 1 test suite ran. (1 ms total)\n"
SKIPS = "[  SKIPPED ] 2 tests, listed below:\n[  SKIPPED ] A.B\n[  SKIPPED ] A.C/0\n"


def is_skipped(output):
    return re.search(list_suites.SKIPPED, output) is not None


class ListSuites(unittest.TestCase):
    def test_parameters_printed_as_bytes_or_addresses_are_found(self):
        self.assertEqual(list_suites.unprinted(LISTED), [])
        unprinted = "  A/0  # GetParam() = 24-byte object <B0-1A F1-60>\n  B/1  # GetParam() = 0x564e6a28b360\n"
        self.assertEqual(list_suites.unprinted(LISTED + unprinted), ["A/0", "B/1"])

    def test_every_case_is_in_one_test(self):
        with tempfile.TemporaryDirectory() as folder:
            program, listed, output = (Path(folder, name) for name in ("program", "listed", "list.cmake"))
            listed.write_text(LISTED, encoding="utf-8")
            program.write_text(f"#!/bin/sh\ncat {listed}\n", encoding="utf-8")
            program.chmod(0o755)
            subprocess.run([sys.executable, "-B", SCRIPT, program, "core", output, "Leak"], check=True)
            text = output.read_text(encoding="utf-8")
        self.assertEqual(re.findall(r"add_test\(\[==\[(.*?)\]==\]", text),
                         ["core: Pose", "core: All/Suite", "core: Typed/0", "core: Leak.OfMemory", "core: Leak.OfFiles"])
        self.assertEqual(re.findall(r"--gtest_filter=(.*?)\]", text),
                         ["Pose.*", "All/Suite.*", "Typed/0.*", "Leak.OfMemory", "Leak.OfFiles"])

    def test_a_suite_is_skipped_if_all_its_cases_are(self):
        self.assertTrue(is_skipped(SUMMARY + "[  PASSED  ] 0 tests.\n" + SKIPS))
        self.assertFalse(is_skipped(SUMMARY + "[  PASSED  ] 1 test.\n" + SKIPS))

    def test_a_failure_among_skipped_cases_is_no_skip(self):
        failed = '[  FAILED  ] 1 test, listed below:\n[  FAILED  ] A.D, where GetParam() = "[  SKIPPED ] x"\n\n 1 FAILED TEST\n'
        self.assertFalse(is_skipped(SUMMARY + "[  PASSED  ] 0 tests.\n" + SKIPS + failed))
        self.assertFalse(is_skipped(SUMMARY + "[  PASSED  ] 0 tests.\n" + failed))


if __name__ == "__main__":
    unittest.main()
