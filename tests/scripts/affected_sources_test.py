#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A change affects the sources that changed and those that include it, directly or not."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from affected_sources import affected, changed_since  # noqa: E402

FILES = {
    "glidar/core/pose.hpp": "",
    "glidar/core/scene.hpp": "#include <glidar/core/pose.hpp>\n#include <vector>\n",
    "glidar/core/scene.cpp": "#include <glidar/core/scene.hpp>\n",
    "glidar/core/error.cpp": "#include <string>\n",
    "tests/support/poses.hpp": "#include <glidar/core/pose.hpp>\n",
    "tests/core/pose_test.cpp": '#include "support/poses.hpp"\n',
    "apps/glidar/flags.hpp": "",
    "apps/glidar/main.cpp": '#  include "flags.hpp"\n',
}


class Affected(unittest.TestCase):
    def setUp(self):
        self.root = Path(self.enterContext(tempfile.TemporaryDirectory())).resolve()
        for name, text in FILES.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        self.sources = {self.root / name for name in FILES if name.endswith(".cpp")}

    def names(self, *changed):
        return {str(file.relative_to(self.root)) for file in affected(self.root, self.sources, set(changed))}

    def test_a_changed_source_is_affected_alone(self):
        self.assertEqual(self.names("glidar/core/error.cpp"), {"glidar/core/error.cpp"})

    def test_a_changed_header_affects_all_that_include_it(self):
        self.assertEqual(self.names("glidar/core/pose.hpp"), {"glidar/core/scene.cpp", "tests/core/pose_test.cpp"})
        self.assertEqual(self.names("apps/glidar/flags.hpp"), {"apps/glidar/main.cpp"})

    def test_other_files_affect_nothing_but_settings_everything(self):
        self.assertEqual(self.names("docs/files.md", "tests/CMakeLists.txt"), set())
        for settings in (".clang-tidy", "tests/.clang-tidy"):
            with self.subTest(settings):
                self.assertEqual(len(self.names(settings)), len(self.sources))

    def git(self, *arguments):
        identity = ["-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false"]
        subprocess.run(["git", "-C", str(self.root), *identity, *arguments], check=True, capture_output=True)

    def test_changes_are_committed_modified_and_new_files(self):
        self.git("init", "-q")
        self.git("add", ".")
        self.git("commit", "-qm", "first")
        first = subprocess.run(["git", "-C", str(self.root), "rev-parse", "HEAD"], capture_output=True, text=True,
                               check=True).stdout.strip()
        self.assertEqual(changed_since(self.root, first), set())
        (self.root / "glidar/core/error.cpp").write_text("int a;\n", encoding="utf-8")
        self.git("commit", "-qam", "second")
        (self.root / "glidar/core/pose.hpp").write_text("int b;\n", encoding="utf-8")
        (self.root / "glidar/core/a name.hpp").write_text("", encoding="utf-8")
        self.assertEqual(changed_since(self.root, first),
                         {"glidar/core/error.cpp", "glidar/core/pose.hpp", "glidar/core/a name.hpp"})

    def test_an_unknown_commit_is_reported(self):
        self.git("init", "-q")
        self.assertIsNone(changed_since(self.root, "0123456"))


if __name__ == "__main__":
    unittest.main()
