#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar depth filter: images, options, errors."""

import unittest
from pathlib import Path

from png_support import PngTest


class FilterCommand(PngTest):
    def test_filters_images_in_the_order_of_time(self):
        for i, depth in enumerate((1000, 1010, 0)):
            self.store(f"d_{i}.png", [[depth] * 3] * 2)
        done = self.succeed("depth", "filter", "d_0.png", "d_1.png", "d_2.png", "--filter", "temporal,alpha=0.5", "-o", "out/")
        self.assertEqual(done.stdout, "66.7 % of pixels with depth, 100.0 % after filtering\n"
                                      "wrote out/d_0.png to out/d_2.png (3 files)\n")
        self.assertEqual([self.grey_rows(f"out/d_{i}.png")[0][0] for i in range(3)], [1000, 1005, 1005])

    def test_one_image_is_a_file(self):
        self.store("d.png", [[500, 0, 700], [500, 600, 700]])
        done = self.succeed("depth", "filter", "d.png", "--filter", "hole_filling,source=left", "-o", "filled.png")
        self.assertIn("wrote filled.png\n", done.stdout)
        self.assertEqual(self.grey_rows("filled.png"), [[500, 500, 700], [500, 600, 700]])

    def test_recommended_filters_halve_the_image(self):
        self.store("d.png", [[2000] * 16] * 8)
        for camera in ((), ("--baseline-mm", "50", "--focal-length-px", "400")):
            self.succeed("depth", "filter", "d.png", *camera, "-o", "small.png")
            self.assertEqual(self.grey_rows("small.png"), [[2000] * 8] * 4)

    def test_quiet_prints_nothing(self):
        self.store("d.png", [[500]])
        self.assertEqual(self.succeed("depth", "filter", "d.png", "--filter", "spatial", "-o", "o.png", "--quiet").stdout, "")

    def test_errors_leave_no_file(self):
        self.store("d.png", [[500, 500]])
        self.store("grey.png", [[5, 5]], bits=8)
        Path(self.folder, "other").mkdir()
        self.store("other/d.png", [[500, 500]])
        cases = (
            (("depth", "filter", "d.png"), "--output"),
            (("depth", "filter", "d.png", "--filter", "spacial", "-o", "o.png"), "spatial"),
            (("depth", "filter", "d.png", "--filter", "spatial,alpha=2", "-o", "o.png"), "0.25 to 1"),
            (("depth", "filter", "d.png", "--filter", "spatial,alpha", "-o", "o.png"), "KEY=VALUE"),
            (("depth", "filter", "d.png", "--filter", "to_depth", "-o", "o.png"), "to_disparity"),
            (("depth", "filter", "d.png", "--baseline-mm", "50", "-o", "o.png"), "focal_length_px"),
            (("depth", "filter", "grey.png", "--filter", "spatial", "-o", "o.png"), "16 bits"),
            (("depth", "filter", "d.png", "other/d.png", "--filter", "spatial", "-o", "o"), "two images have the name d.png"),
            (("depth", "filter", "d.png", "--filter", "spatial", "-o", "d.png"), "d.png"),
            (("depth", "filter", "d.png", "missing.png", "--filter", "spatial", "-o", "o"), "missing.png"),
        )
        before = sorted(p.name for p in Path(self.folder).rglob("*"))
        for command, text in cases:
            with self.subTest(command):
                done = self.run_program(*command)
                self.assertEqual(done.returncode, 2, done)
                self.assertIn(text, done.stderr)
        self.assertEqual(sorted(p.name for p in Path(self.folder).rglob("*")), before)


if __name__ == "__main__":
    unittest.main()
