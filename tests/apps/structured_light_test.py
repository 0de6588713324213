#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar depth structured-light: patterns, decoding, errors."""

import math
import struct
import unittest
from pathlib import Path

from png_support import PngTest

# The camera is the projector, displaced: pixel x of the camera at depth z is pixel x + f b / z of the projector.
SETUP = """
camera: {width: 60, height: 2, fx: 100, fy: 100, cx: 30, cy: 1}
projector: {width: 120, height: 4, fx: 100, fy: 100, cx: 30, cy: 2}
projector_from_camera: {position: [0.2, 0, 0]}
patterns: {steps: 4, period_px: 20}
"""
DISPARITY_PX = 25.0  # depth 0.8 m
IMAGES = [f"i_{i:02}.png" for i in range(4 + 2 * 4)]


def light(image, column):
    """By the definition of the patterns, docs/structured-light.md."""
    if image < 4:
        return 0.5 + 0.5 * math.cos(2 * math.pi * ((column + 0.5) / 20 - image / 4))
    stripe = int((column + 0.5) // 10)
    bit = (stripe ^ stripe >> 1) >> (3 - (image - 4) // 2) & 1
    return bit if image % 2 == 0 else 1 - bit


class StructuredLightCommand(PngTest):
    def setUp(self):
        super().setUp()
        self.write("setup.yaml", SETUP)

    def take_images(self, names=IMAGES):
        for i, name in enumerate(names):
            row = [round(2000 + 40000 * light(i, x + DISPARITY_PX)) for x in range(60)]
            row[7] = 2000  # a shadow
            row[9] = 65535
            self.store(name, [row, row])

    def test_patterns_are_images_of_the_projector(self):
        done = self.succeed("depth", "structured-light", "setup.yaml", "--patterns", "out")
        self.assertEqual(done.stdout, "wrote out/pattern_00.png to out/pattern_11.png (12 files)\n")
        header = self.bytes_of("out/pattern_03.png")[16:26]
        self.assertEqual(struct.unpack(">IIBB", header), (120, 4, 8, 0))

    def test_images_become_depth_with_the_cause_of_each_hole(self):
        self.take_images()
        outputs = ("depth.npy", "depth.png", "coordinate.npy", "phase.npy", "modulation.npy", "part_status.npy", "status.png")
        done = self.succeed("depth", "structured-light", "setup.yaml", *IMAGES, *(word for name in outputs for word in ("-o", name)))
        self.assertTrue(done.stdout.startswith("60x2 pixels: 96.7 % valid, 1.7 % saturated, 1.7 % low_modulation\n"), done.stdout)
        depth = struct.unpack("<120f", self.bytes_of("depth.npy")[-480:])
        for x, value in enumerate(depth[:60]):
            if x in (7, 9):
                self.assertTrue(math.isnan(value))
            else:
                self.assertAlmostEqual(value, 0.8, delta=1e-5)  # levels are rounded to 1/40000
        self.assertEqual(self.grey_rows("depth.png")[1][:10], [8000] * 7 + [0, 8000, 0])
        status = self.bytes_of("part_status.npy")[-120:]
        self.assertEqual((status[6], status[7], status[9]), (0, 2, 1))

    def test_no_file_is_written_unless_all_are(self):
        self.take_images()
        self.store("small.png", [[1] * 60] * 3)
        for arguments in ((*IMAGES[:11], "small.png"), IMAGES[1:]):
            self.refused("depth", "structured-light", "setup.yaml", *arguments, "-o", "depth.npy", "--patterns", "out")
            self.assertFalse(Path(self.folder, "out").exists())

    def test_the_setup_is_not_overwritten(self):
        self.write("pattern_00.png", SETUP)
        self.refused("depth", "structured-light", "pattern_00.png", "--patterns", ".")
        self.assertEqual(self.bytes_of("pattern_00.png").decode(), SETUP)
        self.assertFalse(Path(self.folder, "pattern_01.png").exists())

    def test_errors_about_images_name_the_file(self):
        self.take_images()
        self.store("small.png", [[1] * 60] * 3)
        self.store("byte.png", [[1] * 60] * 2, bits=8)
        odd_first = self.refused("depth", "structured-light", "setup.yaml", "small.png", *IMAGES[1:], "-o", "depth.npy")
        self.assertIn("small.png: has 60x3 pixels; allowed: 60x2", odd_first)
        mixed = self.refused("depth", "structured-light", "setup.yaml", *IMAGES[:11], "byte.png", "-o", "depth.npy")
        self.assertIn("byte.png: 8 bits; allowed: 16 bits, as i_00.png", mixed)

    def test_patterns_without_an_image_are_refused(self):
        self.write("none.yaml", SETUP.replace("steps: 4, period_px: 20", "steps: 0, period_px: 1000"))
        self.assertIn("patterns.period_px", self.refused("depth", "structured-light", "none.yaml", "--patterns", "out"))

    def test_errors_name_what_is_wrong(self):
        self.take_images()
        self.write("bad.yaml", SETUP.replace("steps: 4", "steps: 2"))
        cases = (
            (("setup.yaml",), "--output"),
            (("setup.yaml", "-o", "depth.npy"), "no images"),
            (("setup.yaml", *IMAGES), "neither -o nor --patterns"),
            (("setup.yaml", *IMAGES, "--patterns", "out"), "images but no output"),
            (("setup.yaml", *IMAGES[1:], "-o", "depth.npy"), "12, one for each pattern"),
            (("setup.yaml", *IMAGES, "-o", "phase.png"), "does not state what to write"),
            (("missing.yaml", *IMAGES, "-o", "depth.npy"), "missing.yaml"),
            (("bad.yaml", *IMAGES, "-o", "depth.npy"), "steps"),
            (("setup.yaml", *IMAGES[:11], "missing.png", "-o", "depth.npy"), "missing.png"),
            (("setup.yaml", *IMAGES[:11], "missing.png", "-o", "depth.npy", "--patterns", "out"), "missing.png"),
        )
        for arguments, text in cases:
            with self.subTest(arguments):
                self.assertIn(text, self.refused("depth", "structured-light", *arguments))

    def test_patterns_do_not_replace_images(self):
        patterns = [f"out/pattern_{i:02}.png" for i in range(len(IMAGES))]
        Path(self.folder, "out").mkdir()
        self.take_images(patterns)
        before = self.bytes_of(patterns[0])
        command = ("depth", "structured-light", "setup.yaml", *patterns, "-o", "phase.npy", "--patterns", "out")
        self.assertIn("out/pattern_00.png: is an input file", self.refused(*command))
        self.assertEqual(self.bytes_of(patterns[0]), before)


if __name__ == "__main__":
    unittest.main()
