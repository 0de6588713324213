#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The Dockerfile agrees with the repository: files, commands of ./dev, and folders that the build reads."""

import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from try_dockerfile import ignored, instructions  # noqa: E402

KNOWN = {"FROM", "COPY", "RUN", "WORKDIR", "USER", "ENV", "ENTRYPOINT", "CMD"}


class Dockerfile(unittest.TestCase):
    def test_every_instruction_is_one_of_docker(self):
        self.assertEqual({name for name, _ in instructions()} - KNOWN, set())

    def test_files_it_copies_exist_and_are_not_ignored(self):
        copies = [rest.split() for name, rest in instructions() if name == "COPY"]
        sources = [source for *all_of, _ in copies if "--from" not in all_of[0] for source in all_of]
        self.assertGreaterEqual(len(sources), 1)
        for source in sources:
            self.assertTrue((ROOT / source).exists(), source)
            self.assertFalse(ignored(Path(source)), source)

    def test_commands_of_dev_that_it_runs_exist(self):
        commands = re.findall(r"\./dev (\w+)", " ".join(rest for name, rest in instructions() if name == "RUN"))
        self.assertGreaterEqual(len(commands), 1)
        shown = subprocess.run([ROOT / "dev", "help"], capture_output=True, text=True, check=True).stdout
        for command in commands:
            self.assertRegex(shown, rf"(?m)^  {command} ")

    def test_what_the_build_reads_is_not_ignored(self):
        described = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        described += (ROOT / "cmake/install.cmake").read_text(encoding="utf-8")
        always = ("dev", "CMakeLists.txt", "CMakePresets.json", "scripts", "cmake")
        read = {path.name for path in ROOT.iterdir() if re.search(rf"\b{re.escape(path.name)}\b", described)}
        optional = {"tests", "bench", "build"}  # only other presets read them
        self.assertGreater(len(read), len(optional))
        for path in {*always, *read} - optional:
            self.assertTrue((ROOT / path).exists(), path)
            self.assertFalse(ignored(Path(path)), path)

    def test_dockerignore_keeps_out_whole_folders_and_nothing_alike(self):
        for path in ("build/dev/a.o", "out/x.deb", ".git/config", "python/glidar/__pycache__/a.pyc"):
            self.assertTrue(ignored(Path(path)), path)
        for path in ("glidar/core/pose.hpp", "docs/images/demo.png", "models/out_of_spec.obj", "dev"):
            self.assertFalse(ignored(Path(path)), path)

    def test_the_last_image_runs_the_program_as_an_ordinary_user(self):
        last = instructions()
        last = last[max(i for i, (name, _) in enumerate(last) if name == "FROM") + 1 :]
        self.assertIn(("ENTRYPOINT", '["glidar"]'), last)
        self.assertNotIn(dict(last)["USER"], ("root", "0"))


if __name__ == "__main__":
    unittest.main()
