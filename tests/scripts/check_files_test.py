#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The check of files accepts a good file and reports the line of every type of error."""

import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_files  # noqa: E402

HEAD = "# SPDX-FileCopyrightText: 2026 The GLIDAR developers\n# SPDX-License-Identifier: BSD-3-Clause\n"


class CheckFiles(unittest.TestCase):
    def test_a_good_file_passes(self):
        self.assertEqual(check_files.check_text("tests/apps/a_test.py", HEAD + "wait_until(done, 'the end')\n"), [])

    def test_a_head_without_licence_is_found(self):
        found = check_files.check_text("glidar/a.cpp", "int a;\n" + HEAD.replace("BSD", "MIT"))
        self.assertEqual(found, ["glidar/a.cpp:1: the two SPDX lines are missing at the top"])

    def test_a_long_file_is_found(self):
        found = check_files.check_text("glidar/a.cpp", HEAD + "\n" * 399)
        self.assertEqual(found, ["glidar/a.cpp:400: 401 lines, allowed are 400; split it"])

    def test_a_test_that_sleeps_is_found_with_its_line(self):
        for line in ("time.sleep(0.5)", "sleep(1)", "std::this_thread::sleep_for(200ms);", "usleep(10);",
                     "std::this_thread::sleep_until(then);", "nanosleep(&t, nullptr);", 'script("exec sleep 60");'):
            found = check_files.check_text("tests/apps/a_test.py", HEAD + line + "\n")
            self.assertEqual(len(found), 1, line)
            self.assertTrue(found[0].startswith("tests/apps/a_test.py:3: a test sleeps; "), found)

    def test_words_that_only_look_alike_pass(self):
        self.assertEqual(check_files.check_text("tests/a_test.py", HEAD + "asleep = sleeper = oversleeping\n"), [])

    def test_what_is_no_test_may_sleep(self):
        self.assertEqual(check_files.check_text("scripts/a.py", HEAD + "time.sleep(1)\n"), [])

    def test_every_exception_is_a_file_that_needs_it(self):
        for path, reason in check_files.SLEEPERS.items():
            self.assertRegex((ROOT / path).read_text(encoding="utf-8"), check_files.SLEEP, path)
            self.assertTrue(reason)


if __name__ == "__main__":
    unittest.main()
