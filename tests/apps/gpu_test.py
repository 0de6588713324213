# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The OpenGL renderer from the command line, without a display. The built program is found in PATH."""

import json
import os
import re
import sys
import unittest
from pathlib import Path

from cli_support import CliTest

try:
    import numpy as np

    sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "io/readers"))
    import formats  # independent of the writers
except ImportError:
    np = None

VIEW = ("builtin:asteroid", "--width", "80", "--height", "60")


class GpuRenderer(CliTest):
    def setUp(self):
        super().setUp()
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):
            self.environment.pop(name, None)
        done = self.run_program("render", *VIEW, "--renderer", "gpu", "-o", "try.npy")
        if done.returncode != 0 and re.search("OpenGL: |gpu renderer: ", done.stderr):
            self.skipTest(done.stderr)
        self.assertEqual(done.returncode, 0, done.stderr)

    def render(self, name, *arguments):
        self.succeed("render", *VIEW, *arguments, "-o", name)
        return self.bytes_of(name)

    def test_clouds_have_the_same_bytes_as_with_rays(self):
        for name in ("gpu", "opengl"):
            self.assertEqual(self.render("gpu.csv", "--renderer", name), self.render("rays.csv", "--renderer", "rays"))

    def test_clouds_of_a_moving_scanner_and_object_have_the_same_bytes_as_with_rays(self):
        moving = ("render", "builtin:asteroid", "--sensor", "VLP-16", "--eye", "3,0,0", "--sensor-rate", "0.2,1,0",
                  "--object-rate", "0.3,0,1")
        for name in ("gpu", "rays"):
            self.succeed(*moving, "--renderer", name, "-o", name + ".csv")
        self.assertEqual(self.bytes_of("gpu.csv"), self.bytes_of("rays.csv"))

    def test_the_quantized_framebuffer_is_coarser_and_named_in_the_sidecar(self):
        exact = self.render("exact.csv").splitlines()
        paper = self.render("paper.csv", "--renderer", "opengl", "--quantized-framebuffer").splitlines()
        self.assertAlmostEqual(len(paper), len(exact), delta=5)
        self.assertNotEqual(paper, exact)
        with open(os.path.join(self.folder, "paper.glidar.json"), encoding="utf-8") as file:
            self.assertIn("opengl, quantized framebuffer", json.dumps(json.load(file)))

    @unittest.skipIf(np is None, "no NumPy; ./dev test installs it")
    def test_the_paper_png_is_the_framebuffer_of_the_cloud(self):
        paper = ("--renderer", "opengl", "--quantized-framebuffer")
        self.succeed("render", *VIEW, *paper, "--columns", "xyz,depth,intensity,status", "-o", "a.npz",
                     "-o", "a.framebuffer.png")
        self.succeed("render", *VIEW, "--columns", "xyz,depth", "-o", "exact.npz")
        pixels, texts = formats.read_png(Path(self.folder) / "a.framebuffer.png")
        self.assertEqual((pixels.shape, pixels.dtype), ((60, 80, 4), np.uint8))
        near, far = (float(x) for x in re.search(r"n = (\S+) m, f = (\S+) m", texts["Description"]).groups())
        red, green, blue, alpha = (pixels[:, :, k].astype(float) for k in range(4))
        # equations (6) to (9): D = 256 G + B of 65536 steps between the planes, taken at their centres
        depth = near + (256 * green + blue + 0.5) * (far - near) / 65536
        with np.load(os.path.join(self.folder, "a.npz")) as cloud:
            hit = cloud["status"] == 0
            np.testing.assert_array_equal(hit, alpha > 0)
            np.testing.assert_allclose(cloud["depth"][hit], depth[hit], rtol=1e-12)
            np.testing.assert_allclose(cloud["intensity"][hit], red[hit] / 255, rtol=1e-6)
        self.assertGreater(hit.sum(), 1000)
        with np.load(os.path.join(self.folder, "exact.npz")) as cloud:
            off = np.abs(cloud["depth"] - depth)[hit]
        self.assertLess(np.nanquantile(off, 0.99), 0.52 * (far - near) / 65536)

    def test_the_float_framebuffer_has_no_paper_png(self):
        reported = "x.framebuffer.png: the float framebuffer, which has no such image; allowed: this output with --quantized-framebuffer"
        for renderer in ((), ("--renderer", "opengl")):
            self.assertIn(reported, self.refused("render", *VIEW, *renderer, "-o", "x.framebuffer.png"))

    def test_unsupported_sensors_are_refused(self):
        self.assertIn("add --renderer opengl",
                      self.refused("render", *VIEW, "--quantized-framebuffer", "-o", "x.pcd"))
        self.assertIn("graphics device: 63; allowed: 0: ", self.refused(
            "render", *VIEW, "--renderer", "gpu", "--graphics-device", "63", "-o", "x.pcd"))

    def test_without_opengl_the_error_lists_what_to_install(self):
        self.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = "/nowhere"
        error = self.refused("render", *VIEW, "--renderer", "gpu", "-o", "x.pcd")
        self.assertIn("libgl1-mesa-dri", error)
        self.assertIn("--renderer rays", error)


if __name__ == "__main__":
    unittest.main()
