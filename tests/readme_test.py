#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What README.md and docs/files/images.md show works: marked shell blocks and the commands of pictures run, the C++
is that of examples/render.cpp."""

import json
import os
import re
import subprocess
import tempfile
import textwrap
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
TIME_LIMIT_S = 300  # machines may be very busy


class Readme(unittest.TestCase):
    def test_marked_shell_blocks_run(self):
        blocks = re.findall(r"<!-- run by tests/readme_test.py -->\n```sh\n(.*?)```", README, re.DOTALL)
        self.assertGreaterEqual(len(blocks), 1)
        self.run_blocks(blocks)

    def test_the_commands_of_pictures_run(self):
        first = re.search(r"`(glidar render examples/street\.yaml .*?)`", README)[1]
        pictures = (ROOT / "docs/files/images.md").read_text(encoding="utf-8").split("\n## Pictures\n")[1]
        self.run_blocks([first, re.search(r"```sh\n(.*?)```", pictures, re.DOTALL)[1]])

    def run_blocks(self, blocks):
        """Runs each in one folder: without warnings, and it writes its outputs."""
        with tempfile.TemporaryDirectory() as folder:
            for shown in ("models", "examples", "sensors"):
                (Path(folder) / shown).symlink_to(ROOT / shown)
            for block in blocks:
                done = subprocess.run(
                    ["bash", "-euo", "pipefail", "-c", block],
                    cwd=folder,
                    env={**os.environ, "XDG_CACHE_HOME": folder},
                    capture_output=True,
                    text=True,
                    timeout=TIME_LIMIT_S,
                    check=False,
                )
                self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout}\n{done.stderr}")
                self.assertNotIn("warning", done.stderr)
                for output in re.findall(r" -o (\S+)", block):
                    self.assertGreater((Path(folder) / output).stat().st_size, 0, output)

    def test_cpp_is_the_compiled_example(self):
        example = (ROOT / "examples/render.cpp").read_text(encoding="utf-8")
        shown = re.search(r"// \[README\]\n(.*?) *// \[README\]", example, re.DOTALL)[1]
        self.assertIn(f"```cpp\n{textwrap.dedent(shown)}```", README)

    def test_numbers_are_those_of_the_pages_and_the_program(self):
        peers = (ROOT / "docs/peers.md").read_text(encoding="utf-8").split("<!-- peers.py -->")[1]
        ours = [row.split("|")[3].split("/")[0].strip() for row in peers.splitlines() if row.startswith("| ")][1:]
        self.assertEqual(set(ours), {"0"})
        self.assertIn(f"0 wrong hits in {len(ours)} scenes", README)
        performance = (ROOT / "docs/performance.md").read_text(encoding="utf-8")
        faster = re.search(r"a depth camera is ([\d.]+ to [\d.]+ times as fast as )", README)[1]
        self.assertIn(faster, performance)
        listed = subprocess.run(["glidar", "sensors", "--json"], capture_output=True, timeout=TIME_LIMIT_S, check=True)
        presets = len(json.loads(listed.stdout))
        for stated in re.findall(r"\[(\d+) presets\]", README):
            self.assertEqual(int(stated), presets)

    def test_files_it_links_to_exist(self):
        for target in re.findall(r"\]\(([^)#:]+)\)", README):
            self.assertTrue((ROOT / target).exists(), target)


if __name__ == "__main__":
    unittest.main()
