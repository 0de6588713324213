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
        found = check_files.check_text("glidar/a.cpp", HEAD + "\n" * 799)
        self.assertEqual(found, ["glidar/a.cpp:800: 801 lines, allowed are 800; split it"])

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

    def test_functions_whose_bits_differ_between_machines_are_found_with_their_line(self):
        for line in ("x = std::sin(y);", "return std::pow(2.0, x);", "std::log(x)", "std::hypotf (a, b)", "::cosl(x)",
                     "atan2(y, x)", "a * expf(x)", "erfc(x)", "long double x;", "Eigen::AngleAxisd(a, axis)",
                     "Eigen::Rotation2Df(a)", "a.slerp(t, b)", "m.eulerAngles(0, 1, 2)", "v.array().exp()", "std::tgamma(x)"):
            for path in ("glidar/sensor/a.cpp", "apps/glidar/a.hpp", "python/src/a.cpp"):
                found = check_files.check_text(path, HEAD + line + "\n")
                self.assertEqual(len(found), 1, line)
                self.assertRegex(found[0], rf"^{path}:3: '.*' has other bits on other machines; use glidar/math/")

    def test_exact_functions_own_functions_and_words_pass(self):
        lines = ("std::sqrt(x) + std::fma(a, b, c) + std::floor(x) + std::abs(x) + std::ldexp(x, 2)", "portable_sin(x)",
                 "log(severity, message); // std::sin(x)", '"e sin(φ)" "std::exp(x)"', "exponent(x); distance(x); sinus",
                 "sincos_turns(x).sine; asin_table[0]; q.norm()")
        self.assertEqual(check_files.check_text("glidar/a.cpp", HEAD + "\n".join(lines)), [])

    def test_glidars_own_functions_and_what_is_no_product_may_call_the_library(self):
        for path in ("glidar/math/a.cpp", "tests/math/a_test.cpp", "bench/a.cpp", "scripts/a.py"):
            self.assertEqual(check_files.check_text(path, HEAD + "x = std::sin(long double{1});\n"), [])

    def test_closed_forms_may_call_the_library(self):
        self.assertEqual(check_files.check_text("glidar/verify/a.cpp", HEAD + "x = std::sin(y);\n"), [])

    def test_what_prints_elsewhere_is_found(self):
        for path, line in (("apps/glidar/a.cpp", 'fmt::print("{}", x);'), ("glidar/a.cpp", "std::cout << x;"),
                           ("glidar/a.hpp", "std::fputs(x, stderr);"), ("python/src/a.cpp", 'printf("%s", x);'),
                           ("apps/import/main.cpp", "perror(x);"), ("python/glidar/a.py", "print(x)"),
                           ("python/glidar/campaign/a.py", "sys.stderr.write(x)")):
            found = check_files.check_text(path, HEAD + line + "\n")
            self.assertEqual(found, [f"{path}:3: prints; use apps/glidar/run/console.hpp or python/glidar/_printing.py"], line)

    def test_what_prints_nothing_or_is_no_product_passes(self):
        for path, line in (("apps/glidar/a.cpp", 'print("{}", x); print_lines(stdout, x); std::snprintf(a, 9, "%g", x);'),
                           ("glidar/a.cpp", "// std::cout"), ("python/glidar/a.py", "print_line(x); fingerprint(x)"),
                           ("scripts/a.py", "print(x)"), ("tests/a_test.cpp", "std::cout << x;")):
            self.assertEqual(check_files.check_text(path, HEAD + line + "\n"), [], line)

    def test_every_exception_is_a_file_that_needs_it(self):
        for path, reason in check_files.SLEEPERS.items():
            self.assertRegex((ROOT / path).read_text(encoding="utf-8"), check_files.SLEEP, path)
            self.assertTrue(reason)
        for path, reason in check_files.PRINTERS.items():
            text = (ROOT / path).read_text(encoding="utf-8")
            self.assertRegex(text, check_files.PRINTS[Path(path).suffix], path)
            self.assertTrue(reason)


if __name__ == "__main__":
    unittest.main()
