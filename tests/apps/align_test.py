#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar depth align: images, the file of the cameras, errors."""

import unittest

from png_support import PngTest

CAMERAS = """
depth: {width: 8, height: 4, fx: 8, fy: 8, cx: 4, cy: 2}
colour: {width: 16, height: 8, fx: 16, fy: 16, cx: 8, cy: 4}
colour_from_depth: {position: [POSITION]}
"""


class AlignCommand(PngTest):
    def setUp(self):
        super().setUp()
        self.write("cameras.yaml", CAMERAS.replace("POSITION", "0, 0, 0"))
        self.write("moved.yaml", CAMERAS.replace("POSITION", "0, 0, 0.5"))
        self.store("d.png", [[2000] * 8] * 4)

    def test_fills_the_finer_image(self):
        done = self.succeed("depth", "align", "d.png", "--cameras", "cameras.yaml", "-o", "aligned.png")
        self.assertEqual(done.stdout, "100.0 % of pixels with depth, 100.0 % after alignment\nwrote aligned.png\n")
        self.assertEqual(self.grey_rows("aligned.png"), [[2000] * 16] * 8)

    def test_depths_are_along_the_boresight_of_either_camera(self):
        for options, depth in (((), 2500), (("--keep-depth",), 2000)):
            self.succeed("depth", "align", "d.png", "--cameras", "moved.yaml", *options, "-o", "aligned.png")
            rows = self.grey_rows("aligned.png")
            self.assertEqual(rows[4][8], depth)
            self.assertEqual(rows[0][0], 0)  # beside the image that the depth camera sees

    def test_several_images_keep_their_names(self):
        self.store("e.png", [[1000] * 8] * 4)
        self.succeed("depth", "align", "d.png", "e.png", "--cameras", "cameras.yaml", "-o", "out", "--quiet")
        self.assertEqual(self.grey_rows("out/e.png"), [[1000] * 16] * 8)

    def test_the_file_of_the_cameras_is_not_overwritten(self):
        before = self.bytes_of("cameras.yaml")
        self.refused("depth", "align", "d.png", "--cameras", "cameras.yaml", "-o", "cameras.yaml")
        self.assertEqual(self.bytes_of("cameras.yaml"), before)

    def test_errors_name_what_is_wrong(self):
        self.store("small.png", [[1, 2]])
        self.write("bad.yaml", CAMERAS.replace("POSITION", "0, 0, 0").replace("colour:", "rgb:"))
        cases = (
            (("d.png", "-o", "o.png"), "--cameras"),
            (("d.png", "--cameras", "cameras.yaml"), "--output"),
            (("d.png", "--cameras", "missing.yaml", "-o", "o.png"), "missing.yaml"),
            (("d.png", "--cameras", "bad.yaml", "-o", "o.png"), "colour"),
            (("small.png", "--cameras", "cameras.yaml", "-o", "o.png"), "8x4"),
        )
        for arguments, text in cases:
            with self.subTest(arguments):
                self.assertIn(text, self.refused("depth", "align", *arguments))

    def test_inputs_are_not_overwritten(self):
        before = self.bytes_of("cameras.yaml"), self.bytes_of("d.png")
        for name in ("cameras.yaml", "d.png"):
            self.assertIn("is an input file", self.refused("depth", "align", "d.png", "--cameras", "cameras.yaml", "-o", name))
        self.assertEqual((self.bytes_of("cameras.yaml"), self.bytes_of("d.png")), before)


if __name__ == "__main__":
    unittest.main()
