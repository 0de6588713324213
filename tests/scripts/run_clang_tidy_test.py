#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The runner of clang-tidy checks compatible sources together, and reports the findings of each."""

import shutil
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import run_clang_tidy  # noqa: E402

GOOD = "namespace glidar {{\nint {0}(int count) {{\n  return count;\n}}\n}}\n"
BAD = "namespace glidar {{\nint {0}(int count, int unused) {{\n  return count;\n}}\n}}\n"


class Grouping(unittest.TestCase):
    def setUp(self):
        self.root = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.build = self.root / "build"
        for name, value in (("ROOT", self.root), ("CACHE", self.root / "cache")):
            self.addCleanup(setattr, run_clang_tidy, name, getattr(run_clang_tidy, name))
            setattr(run_clang_tidy, name, value)
        run_clang_tidy.CACHE.mkdir()
        shutil.copy(ROOT / ".clang-tidy", self.root)

    def source(self, name, text, options="-O2"):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path, str(self.root), f"c++ {options} -o {path.stem}.o -c {path}"

    def names(self, sources, **words):
        return [[file.stem for file, _, _ in members] for members in run_clang_tidy.groups_of(sources, **words)]

    def test_sources_go_together_up_to_a_number(self):
        sources = [self.source(f"glidar/{name}.cpp", GOOD.format(name)) for name in "abcde"]
        self.assertEqual(self.names(sources, size=3), [["a", "b", "c"], ["d", "e"]])

    def test_sources_of_other_layers_and_options_do_not(self):
        sources = [self.source("glidar/io/a.cpp", ""), self.source("glidar/link/b.cpp", ""),
                   self.source("glidar/io/c.cpp", "", "-O3"), self.source("glidar/io/bags/d.cpp", "")]
        self.assertEqual(self.names(sources), [["a", "d"], ["b"], ["c"]])

    def test_programs_do_not(self):
        sources = [self.source("bench/a.cpp", "int main() {\n}\n"), self.source("bench/b.cpp", "int main(int n, char** v) {\n}\n")]
        self.assertEqual(self.names(sources), [["a"], ["b"]])

    def test_sources_that_define_the_same_do_not(self):
        for text in ("constexpr double kLimit_m = 1.0;\n", "constexpr int kTable[3] = {1, 2, 3};\n",
                     "struct Row {\n};\n", "double wrapped(double angle_rad) {\n", "using Points = int;\n"):
            with self.subTest(text):
                sources = [self.source("glidar/a.cpp", text), self.source("glidar/b.cpp", text)]
                self.assertEqual(self.names(sources), [["a"], ["b"]])

    def test_a_local_constant_and_a_definition_of_its_name_part_them(self):
        sources = [self.source("glidar/a.cpp", "constexpr double kDegree = 0.01;\n"),
                   self.source("glidar/b.cpp", "void turn() {\n  constexpr double kDegree = 0.02;\n}\n"),
                   self.source("glidar/c.cpp", "void bend() {\n  constexpr double kDegree = 0.03;\n}\n")]
        self.assertEqual(self.names(sources), [["a"], ["b", "c"]])

    def test_functions_whose_parameters_differ_by_name_part_them(self):
        sources = [self.source("glidar/a.cpp", "int size(const A& first, B* second) {\n}\n"),
                   self.source("glidar/b.cpp", "int size(const A& one, B* other) {\n}\n")]
        self.assertEqual(self.names(sources), [["a"], ["b"]])

    def test_overloads_and_words_in_functions_do_not_part_them(self):
        sources = [self.source("glidar/a.cpp", "using ::testing::Eq;\nint size(A a) {\n  const int row = 1;\n}\n"),
                   self.source("glidar/b.cpp", "using ::testing::Eq;\nint size(B b) {\n  const int row = 1;\n}\n")]
        self.assertEqual(self.names(sources), [["a", "b"]])

    def check(self, sources):
        """The findings, and which sources have stamps."""
        self.write_database(sources)
        stamps = run_clang_tidy.stamps_of(sources)
        text = run_clang_tidy.findings(self.build, sources, stamps)
        return text, [file.stem for file, stamp in stamps.items() if stamp.exists()]

    @unittest.skipIf(shutil.which(run_clang_tidy.CLANG_TIDY) is None, "no clang-tidy; ./dev lint installs it")
    def test_a_fault_of_one_source_is_told_of_it_and_good_ones_pass(self):
        good = [self.source(f"glidar/{name}.cpp", GOOD.format(name)) for name in "ab"]
        self.assertEqual(self.check(good), ("", ["a", "b"]))
        bad = self.source("glidar/c.cpp", BAD.format("c"))
        text, passed = self.check([*good, bad])
        self.assertRegex(text, r"glidar/c\.cpp:2:22: error: parameter 'unused' is unused")
        self.assertEqual(passed, ["a", "b"])

    @unittest.skipIf(shutil.which(run_clang_tidy.CLANG_TIDY) is None, "no clang-tidy; ./dev lint installs it")
    def test_sources_that_do_not_compile_together_are_checked_apart(self):
        both = [self.source("glidar/a.cpp", "namespace {\nint hidden;\n}\nint glidar_a = hidden;\n"),
                self.source("glidar/b.cpp", "namespace {\nlong hidden;\n}\nlong glidar_b = hidden;\n")]
        self.write_database(both)
        self.assertFalse(run_clang_tidy.check_together(self.build, both))
        self.assertEqual(self.check(both), ("", ["a", "b"]))

    @unittest.skipIf(shutil.which(run_clang_tidy.CLANG_TIDY) is None, "no clang-tidy; ./dev lint installs it")
    def test_a_source_is_checked_again_when_what_it_includes_or_its_options_change(self):
        header = self.root / "glidar/a.hpp"
        source = self.source("glidar/a.cpp", "#include <glidar/a.hpp>\n")
        header.write_text("", encoding="utf-8")
        before = run_clang_tidy.stamps_of([source])[source[0]]
        self.assertEqual(run_clang_tidy.stamps_of([source])[source[0]], before)
        self.assertNotEqual(run_clang_tidy.stamps_of([self.source("glidar/a.cpp", source[0].read_text(), "-O1")])[source[0]], before)
        header.write_text("// changed\n", encoding="utf-8")
        self.assertNotEqual(run_clang_tidy.stamps_of([source])[source[0]], before)

    def write_database(self, sources):
        self.build.mkdir(exist_ok=True)
        entries = [{"directory": folder, "command": command, "file": str(file)} for file, folder, command in sources]
        (self.build / "compile_commands.json").write_text(run_clang_tidy.json.dumps(entries), encoding="utf-8")


if __name__ == "__main__":
    unittest.main()
