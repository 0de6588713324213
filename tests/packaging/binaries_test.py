#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Programs and libraries of the build under test, built and installed, load no library from the current folder
and are hardened. Those in Debian packages and the wheel are checked where these are made."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(shutil.which("glidar")).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_binaries  # noqa: E402

HIJACK = """
#include <stdlib.h>
__attribute__((constructor)) static void hijack(void) { _Exit(99); }
"""


def is_hardened():
    cache = (BUILD / "CMakeCache.txt").read_text(encoding="utf-8")
    return (re.search(r"(?m)^GLIDAR_HARDENING:BOOL=ON$", cache) is not None
            and "CMAKE_BUILD_TYPE:STRING=Debug" not in cache)


class Binaries(unittest.TestCase):
    def require_sound(self, folder, least):
        count, complaints = check_binaries.check([folder], search_path_only=not is_hardened())
        self.assertEqual(complaints, [])
        self.assertGreaterEqual(count, least)

    def setUp(self):
        self.work = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_all_that_is_built_has_safe_search_paths_and_is_hardened(self):
        self.require_sound(BUILD / "apps", least=2)
        # not the folders below: other tests make and remove files there
        programs = [path for path in (BUILD / "tests").glob("glidar_*") if path.is_file() and os.access(path, os.X_OK)]
        self.assertGreaterEqual(len(programs), 8)
        for program in programs:
            self.assertEqual(check_binaries.problems(program, search_path_only=not is_hardened()), [], program)
        if (BUILD / "python/glidar").is_dir():
            self.require_sound(BUILD / "python", least=1)

    def test_all_that_is_installed_has_safe_search_paths_and_is_hardened(self):
        subprocess.run(["cmake", "--install", BUILD, "--prefix", self.work], capture_output=True, check=True)
        self.require_sound(self.work, least=2)

    def test_a_library_in_the_current_folder_is_not_loaded(self):
        """The program starts in a folder that holds a false copy of every library that it needs."""
        program = BUILD / "apps/glidar/glidar"
        needed = re.findall(r"NEEDED.*\[(.*)\]", check_binaries.readelf("-d", program))
        self.assertIn("libzmq.so.5", needed)
        subprocess.run(["cc", "-shared", "-fPIC", "-x", "c", "-", "-o", self.work / "false.so"],
                       input=HIJACK, text=True, check=True)
        for name in needed:
            if not name.startswith("ld-linux"):
                shutil.copy(self.work / "false.so", self.work / name)
        environment = {key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"}
        model = self.work / "a.obj"
        model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
        done = subprocess.run([program, "info", model.name, "--no-cache"], cwd=self.work, env=environment,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
