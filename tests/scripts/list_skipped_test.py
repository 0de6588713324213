#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What `./dev test` prints about skipped tests, from the logs of a real run of CTest; and that tests give a remedy."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = """cmake_minimum_required(VERSION 3.25)
project(x NONE)
enable_testing()
function(a_test name text)
  add_test(NAME "${name}" COMMAND ${CMAKE_COMMAND} -E echo "${text}")
  set_tests_properties("${name}" PROPERTIES SKIP_REGULAR_EXPRESSION "kipped")
endfunction()
add_test(NAME "io: passes" COMMAND ${CMAKE_COMMAND} -E echo "skipped: not this one; nothing")
a_test("python: a_test.py" "before\\nskipped: no x; install x\\nafter")
a_test("io: Suite" "[ RUN      ] Suite.Case\\nio/a_test.cpp:12: Skipped\\n\\nno y; install y\\n\\n[  SKIPPED ] Suite.Case")
a_test("python package: b_test.py" "SKIPPED [2] tests/b_test.py:3: could not import 'z': No module named 'z'\\n2 skipped in 0.1s")
a_test("node: c_test.mjs" "kipped")
"""
LINES = """skipped: python: a_test.py: no x; install x
skipped: io: Suite: no y; install y
skipped: python package: b_test.py: could not import 'z': No module named 'z'; ./dev test installs it, with apt-get or from PyPI
skipped: node: c_test.mjs: no reason given; run it alone: ./dev test -V -R NAME
"""


class ListSkipped(unittest.TestCase):
    def test_a_line_for_every_skipped_test_names_reason_and_remedy(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "CMakeLists.txt").write_text(TESTS, encoding="utf-8")
            subprocess.run(["cmake", "-S", folder, "-B", folder], capture_output=True, check=True)
            ran = subprocess.run(["ctest", "-j", "3"], cwd=folder, capture_output=True, check=True)
            Path(folder, "output").write_bytes(ran.stdout)
            done = subprocess.run([sys.executable, ROOT / "scripts/list_skipped.py", "output", "Testing/Temporary/LastTest.log"],
                                  cwd=folder, capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, LINES)

    def test_every_reason_in_the_tests_has_a_remedy(self):
        """Of the texts in the sources; those of errors have one."""
        skips = re.compile(r'GTEST_SKIP\(\)\s*<< "([^"]*)"|pytest\.skip\(f?"([^"]*)"|skipTest\(f?"([^"]*)"|reason=f?"([^"]*)"')
        for path in sorted((ROOT / "tests").rglob("*")):
            if path.suffix not in (".py", ".cpp", ".hpp") or path.name == Path(__file__).name:
                continue
            for found in skips.finditer(path.read_text(encoding="utf-8")):
                reason = next(group for group in found.groups() if group is not None)
                with self.subTest(path.name, reason=reason):
                    self.assertIn("; ", reason)


if __name__ == "__main__":
    unittest.main()
