#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the pages for users show works: marked blocks run, and print the numbers that are shown. Pages that need packages
from PyPI: tests/python/pages_test.py."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent / folder) for folder in ("support", "apps")]
from cli_support import free_ports  # noqa: E402
from doc_blocks import ROOT, link_inputs, run_page  # noqa: E402
from skipping import importing  # noqa: E402
from waiting import MAX_WAIT_S  # noqa: E402

with importing():  # the pages use them
    import numpy  # noqa: F401
    import zmq  # noqa: F401

NAME = "tests/docs_test.py"
DOCS = ROOT / "docs"


class Pages(unittest.TestCase):
    def run_page(self, page, *replace):
        with tempfile.TemporaryDirectory() as folder:
            link_inputs(folder)
            run_page(page, NAME, folder, replace)

    def test_installation(self):
        self.run_page("docs/install.md")

    def test_tutorial_of_a_depth_camera(self):
        self.run_page("docs/tutorial/1-depth-camera.md")

    def test_tutorial_of_a_lidar(self):
        self.run_page("docs/tutorial/2-lidar.md")

    def test_tutorial_of_the_loop(self):
        self.run_page("docs/tutorial/4-loop.md", ("5600", str(free_ports())))

    def test_doppler(self):
        self.run_page("docs/doppler.md")

    def test_stereo(self):
        self.run_page("docs/stereo.md")

    def test_time_of_flight(self):
        self.run_page("docs/time-of-flight.md")

    def test_depth_filters(self):
        self.run_page("docs/depth-filters.md")

    def test_structured_light(self):
        self.run_page("docs/structured-light.md")

    def test_troubleshooting(self):
        self.run_page("docs/troubleshooting.md")

    def test_figures_of_the_paper(self):
        try_opengl = ["glidar", "render", "builtin:box", "--renderer", "gpu", "-o", "-", "--format", "npy"]
        done = subprocess.run(try_opengl, capture_output=True, timeout=MAX_WAIT_S, check=False)
        if done.returncode != 0 and b"OpenGL: " in done.stderr:
            self.skipTest(done.stderr.decode())
        self.run_page("docs/woods2016.md")


class Index(unittest.TestCase):
    def test_the_index_lists_every_page(self):
        index = (DOCS / "README.md").read_text(encoding="utf-8")
        for page in DOCS.rglob("*.md"):
            if page != DOCS / "README.md":
                self.assertIn(f"({page.relative_to(DOCS)})", index)


class Citation(unittest.TestCase):
    def test_it_names_this_version(self):
        cited = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)[1]
        built = re.search(r"project\(glidar VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
        self.assertEqual(cited, built)


if __name__ == "__main__":
    unittest.main()
