#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The check of programs and libraries accepts a good one and reports every type of error."""

import shutil
import platform
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests/support")]
import check_binaries  # noqa: E402
from skipping import IN_DEV, skip  # noqa: E402

CODE = """
#include <stdio.h>
#include <string.h>
int one(void) { return 1; } int two(void) { return 2; } int three(void) { return 3; } int four(void) { return 4; }
int five(void) { return 5; } int six(void) { return 6; } int seven(void) { return 7; } int eight(void) { return 8; }
int main(int argc, char** argv) {
  char text[16];
  strcpy(text, argv[argc - 1]);  /* a copy that can be checked */
  return puts(text);
}
"""
GOOD = ("-O2", "-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2", "-fstack-protector-strong", "-fPIE", "-pie",
        "-Wl,-z,relro,-z,now,-z,noexecstack")
MARKS_JUMPS = ("-fcf-protection=full",) if platform.machine() == "x86_64" else ()
GOOD += MARKS_JUMPS


class CheckBinaries(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def complaints(self, *options, name="glidar", **words):
        """The output of the check for a program that is compiled with these options, without its path."""
        program = self.folder / name
        subprocess.run(["cc", *options, "-x", "c", "-", "-o", program], input=CODE, text=True, check=True)
        count, complaints = check_binaries.check([self.folder], **words)
        self.assertEqual(count, 1)
        return [complaint.removeprefix(f"{program}: ") for complaint in complaints]

    def test_a_hardened_program_without_search_path_passes(self):
        self.assertEqual(self.complaints(*GOOD), [])

    def test_absolute_search_paths_and_those_from_the_program_pass(self):
        self.assertEqual(self.complaints(*GOOD, "-Wl,-rpath,$ORIGIN/../lib:$ORIGIN:/opt/lib"), [])

    def test_an_empty_entry_of_a_search_path_is_found_wherever_it_stands(self):
        for path in (":/opt/lib", "/opt/lib:", "/opt::/lib", "::::"):
            with self.subTest(path):
                self.assertEqual(self.complaints(*GOOD, f"-Wl,-rpath,{path}"), [
                    f"the search path for libraries '{path}' has an empty entry: the current folder"])

    def test_a_relative_entry_of_a_search_path_is_found(self):
        self.assertEqual(self.complaints(*GOOD, "-Wl,-rpath,/opt/lib:lib"), [
            "the search path for libraries '/opt/lib:lib' has the relative entry 'lib'"])

    def test_the_old_kind_of_search_path_is_found_too(self):
        found = self.complaints(*GOOD, "-Wl,--disable-new-dtags,-rpath,$ORIGINAL/lib")
        self.assertEqual(found, ["the search path for libraries '$ORIGINAL/lib' has the relative entry '$ORIGINAL/lib'"])

    def test_every_missing_hardening_is_named(self):
        for option, fault in (
                ("-no-pie", "it is not position-independent"),
                ("-Wl,-z,lazy", "its relocations are not read-only (-z relro -z now)"),
                ("-Wl,-z,norelro", "its relocations are not read-only (-z relro -z now)"),
                ("-Wl,-z,execstack", "its stack is executable"),
                ("-fno-stack-protector", "it has no stack protector"),
                ("-U_FORTIFY_SOURCE", "copies are not checked (_FORTIFY_SOURCE)")):
            with self.subTest(option):
                self.assertEqual(self.complaints(*GOOD, option), [fault])

    @unittest.skipUnless(MARKS_JUMPS, "targets of jumps are marked on x86-64 only; nothing to do")
    def test_unmarked_targets_of_jumps_are_found(self):
        self.assertEqual(self.complaints(*GOOD, "-fcf-protection=none"),
                         ["targets of indirect jumps are not marked (-fcf-protection)"])

    def test_libraries_of_others_need_a_safe_search_path_only(self):
        self.assertEqual(self.complaints("-Wl,-rpath,:", "-no-pie", name="libfoo.so.1"), [
            "the search path for libraries ':' has an empty entry: the current folder"])

    def test_hardening_can_be_left_out(self):
        self.assertEqual(self.complaints("-no-pie", search_path_only=True), [])

    def test_texts_links_and_object_files_are_no_programs(self):
        (self.folder / "text").write_text("ELF")
        (self.folder / "link").symlink_to("/bin/sh")
        subprocess.run(["cc", "-c", "-x", "c", "-", "-o", self.folder / "a.o"], input=CODE, text=True, check=True)
        self.assertEqual(check_binaries.check([self.folder]), (0, []))

    def test_a_folder_without_programs_is_an_error(self):
        done = subprocess.run([sys.executable, ROOT / "scripts/check_binaries.py", self.folder],
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (1, f"{self.folder}: no program or library\n"))


if __name__ == "__main__":
    if shutil.which("cc") is None or shutil.which("readelf") is None:
        skip("no cc or readelf", IN_DEV)
    unittest.main()
