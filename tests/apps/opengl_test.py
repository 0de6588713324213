# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The OpenGL renderer from the command line, without a display. The built program is found in PATH."""

import json
import os
import unittest

from cli_support import CliTest

VIEW = ("builtin:asteroid", "--width", "80", "--height", "60")


class OpenglRenderer(CliTest):
    def setUp(self):
        super().setUp()
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):
            self.environment.pop(name, None)
        done = self.run_program("render", *VIEW, "--renderer", "opengl", "-o", "try.npy")
        if done.returncode != 0 and "OpenGL: " in done.stderr:
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 0, done.stderr)

    def render(self, name, *arguments):
        self.succeed("render", *VIEW, *arguments, "-o", name)
        return self.bytes_of(name)

    def test_clouds_are_those_of_embree_to_the_byte(self):
        self.assertEqual(self.render("drawn.csv", "--renderer", "opengl"),
                         self.render("cast.csv"))

    def test_the_paper_target_is_coarser_and_told_beside_the_cloud(self):
        exact = self.render("exact.csv").splitlines()
        paper = self.render("paper.csv", "--renderer", "opengl", "--render-target", "paper").splitlines()
        self.assertAlmostEqual(len(paper), len(exact), delta=5)
        self.assertNotEqual(paper, exact)
        with open(os.path.join(self.folder, "paper.csv.json"), encoding="utf-8") as file:
            self.assertIn("opengl, paper target", json.dumps(json.load(file)))

    def test_what_it_cannot_draw_is_refused(self):
        self.assertIn("add --renderer opengl",
                      self.refused("render", *VIEW, "--render-target", "paper", "-o", "x.pcd"))
        self.assertIn("use --renderer embree", self.refused("verify", "--renderer", "opengl"))
        self.assertIn("graphics device: 63; allowed: 0: ", self.refused(
            "render", *VIEW, "--renderer", "opengl", "--graphics-device", "63", "-o", "x.pcd"))

    def test_a_machine_without_opengl_is_told_what_to_install(self):
        self.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = "/nowhere"
        error = self.refused("render", *VIEW, "--renderer", "opengl", "-o", "x.pcd")
        self.assertIn("libgl1-mesa-dri", error)
        self.assertIn("--renderer embree", error)


if __name__ == "__main__":
    unittest.main()
