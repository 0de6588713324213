#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""An installed library is found by `pip install .` (cmake/fingerprint.cmake) only while it is of the same sources."""

import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TIME_LIMIT_S = 300
WRITE = "glidar_write_same_sources({prefix}/lib/cmake/glidar/glidarSameSources.cmake {root})"
FIND = """set(PROJECT_SOURCE_DIR {root})
glidar_find_same_sources()
message("found: ${{glidar_FOUND}}, loaded: ${{LOADED}}")"""


class SameSources(unittest.TestCase):
    def setUp(self):
        work = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.root, self.prefix = work / "a clone", work / "an installation"
        for name in ("CMakeLists.txt", "glidar/core/pose.cpp", "apps/glidar/main.cpp", "sensors/VLP-16.yaml"):
            self.write(name, f"{name}\n")
        package = self.prefix / "lib/cmake/glidar"
        package.mkdir(parents=True)
        (package / "glidarConfig.cmake").write_text("set(LOADED yes)\n", encoding="utf-8")
        self.cmake(WRITE)

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def cmake(self, code, root=None):
        script = self.prefix / "script.cmake"
        code = code.format(root=f"[[{root or self.root}]]", prefix=str(self.prefix).replace(" ", "\\ "))
        script.write_text(f"cmake_minimum_required(VERSION 3.25)\ninclude([[{ROOT}/cmake/fingerprint.cmake]])\n{code}\n", encoding="utf-8")
        done = subprocess.run(["cmake", f"-Dglidar_ROOT={self.prefix}", "-P", script], capture_output=True, text=True,
                              timeout=TIME_LIMIT_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr.strip()

    def test_the_same_sources_are_found_also_in_another_folder(self):
        self.write("tests/x.cpp", "not installed\n")
        self.write("glidar/__pycache__/x.pyc", "made by Python\n")
        self.assertEqual(self.cmake(FIND), "found: 1, loaded: yes")
        moved = self.root.rename(self.root.with_name("moved"))
        self.assertEqual(self.cmake(FIND, moved), "found: 1, loaded: yes")

    def test_a_source_that_is_changed_new_renamed_or_gone_is_another_library(self):
        source = self.root / "glidar/core/pose.cpp"
        changes = (lambda: source.write_text("changed\n", encoding="utf-8"), lambda: self.write("glidar/new.hpp", ""),
                   lambda: source.rename(source.with_suffix(".cc")), (self.root / "sensors/VLP-16.yaml").unlink)
        for change in changes:
            self.cmake(WRITE)
            self.assertEqual(self.cmake(FIND), "found: 1, loaded: yes")
            change()
            self.assertEqual(self.cmake(FIND), "found: 0, loaded:")


if __name__ == "__main__":
    unittest.main()
