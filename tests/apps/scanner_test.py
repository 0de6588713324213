#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Structured-light cameras of sensor files: glidar render, explain and structured-light."""

import math
import statistics
import struct
import unittest
from pathlib import Path

from png_support import PngTest

SCANNER = """
name: scanner
wavelength_nm: 460
optics: {width: 64, height: 48, fov_x_deg: 20}
limits: {far_m: 2}
noise: [{type: range_gaussian, sigma_m: 0.001}]
depth_model: physical
depth_camera:
  type: structured_light
  projector: {width: 128, height: 80, fov_x_deg: 24}
  projector_from_camera: {position: [-0.19403, 0, 0.04851], rotation_vector: [0, 0.245, 0]}
  patterns: {steps: 4, period_px: 16}
  imager: {focal_length_mm: 12, f_number: 4, auto_exposure: {target: 0.3, max_time_ms: 1000}}
"""
RENDER = ("render", "builtin:sphere:radius=0.1", "--sensor-pose", "0,0,-0.8,1,0,0,0", "--sensor")
IMAGES = 4 + 2 * 4


def sphere_depth_m(u, v):
    """Depth of the sphere along the boresight at a pixel of SCANNER, with the pose of RENDER; 0 beside it."""
    focal = 32 / math.tan(math.radians(10))
    x, y = (u + 0.5 - 32) / focal, (v + 0.5 - 24) / focal
    squared = x * x + y * y + 1
    root = 0.8**2 - squared * (0.8**2 - 0.1**2)
    return (0.8 - math.sqrt(root)) / squared if root > 0 else 0.0


class ScannerCommands(PngTest):
    def setUp(self):
        super().setUp()
        self.write("scanner.yaml", SCANNER)

    def patterns_of(self, name):
        """Images x 48 x 64 bytes of a NumPy file."""
        data = self.bytes_of(name)
        length = struct.unpack("<H", data[8:10])[0]
        self.assertIn(b"'|u1'", data[10:10 + length])
        self.assertIn(b"(12, 48, 64, )", data[10:10 + length])
        return data[10 + length:]

    def test_images_of_all_patterns_decode_to_the_rendered_depth(self):
        self.succeed(*RENDER, "scanner.yaml", "-o", "v.patterns.npy", "-o", "v.depth.png", "--depth-scale", "10000")
        levels = self.patterns_of("v.patterns.npy")
        size = 64 * 48
        for i in range(IMAGES):
            image = levels[i * size:(i + 1) * size]
            self.store(f"i_{i:02}.png", [[257 * level for level in image[64 * row:64 * row + 64]] for row in range(48)])
        names = [f"i_{i:02}.png" for i in range(IMAGES)]
        self.write("setup.yaml", SCANNER.replace("  patterns:", "  decoding: {min_modulation: 1028, min_code_difference: 1028}\n  patterns:"))
        self.succeed("depth", "structured-light", "setup.yaml", *names, "-o", "d.depth.png")
        rendered, decoded = self.grey_rows("v.depth.png"), self.grey_rows("d.depth.png")
        pairs = [(a, b) for one, other in zip(rendered, decoded) for a, b in zip(one, other) if a > 0]
        self.assertGreater(len(pairs), 300)
        for a, b in pairs:
            self.assertLessEqual(abs(a - b), 1)  # units of 0.1 mm

    def test_the_array_of_all_images_decodes_to_the_rendered_depth(self):
        self.succeed(*RENDER, "scanner.yaml", "-o", "v.patterns.npy", "-o", "v.depth.png", "--depth-scale", "10000")
        self.succeed("depth", "structured-light", "scanner.yaml", "v.patterns.npy", "-o", "d.depth.png")
        pairs = [pair for rows in zip(self.grey_rows("v.depth.png"), self.grey_rows("d.depth.png")) for pair in zip(*rows)]
        self.assertGreater(sum(a > 0 for a, _ in pairs), 300)
        self.assertTrue(all(abs(a - b) <= 1 for a, b in pairs if a > 0))

    def test_arrays_of_another_kind_are_refused(self):
        def array(name, description, shape, data):
            head = f"{{'descr': '{description}', 'fortran_order': {name == 'columns.npy'}, 'shape': {shape}, }}".ljust(117) + "\n"
            Path(self.folder, name).write_bytes(b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + data)
        size = IMAGES * 48 * 64
        array("floats.npy", "<f4", (IMAGES, 48, 64), bytes(4 * size))
        array("columns.npy", "|u1", (IMAGES, 48, 64), bytes(size))
        array("flat.npy", "|u1", (48, 64), bytes(48 * 64))
        array("short.npy", "<u2", (IMAGES, 48, 64), bytes(size))
        array("turned.npy", "|u1", (IMAGES, 64, 48), bytes(size))
        array("few.npy", "|u1", (IMAGES - 1, 48, 64), bytes(size))
        cases = (("floats.npy", "uint8 or uint16"), ("columns.npy", "row by row"), ("flat.npy", "images x rows x columns"),
                 ("short.npy", "fewer numbers"), ("turned.npy", "64x48"), ("few.npy", "one for each pattern"))
        for name, text in cases:
            with self.subTest(name):
                self.assertIn(text, self.refused("depth", "structured-light", "scanner.yaml", name, "-o", "d.depth.npy"))

    def test_explain_prints_the_images_and_tests_of_a_pixel(self):
        self.succeed(*RENDER, "scanner.yaml", "-o", "v.pcd", "-o", "v.patterns.npy")
        levels = self.patterns_of("v.patterns.npy")
        text = self.succeed("explain", "v.pcd", "--row", "24", "--col", "32").stdout
        pixel = [levels[i * 64 * 48 + 24 * 64 + 32] for i in range(IMAGES)]
        self.assertIn("fringes: grey levels " + " ".join(map(str, pixel[:4])) + "\n", text)
        self.assertIn("Gray code: grey levels " + " ".join(map(str, pixel[4:])) + "\n", text)
        self.assertIn("electrons of each image, on average: ", text)
        self.assertIn("true coordinate ", text)
        self.assertIn("modulation ", text)
        self.assertIn("stripe ", text)
        for test in ("saturated", "low_modulation", "weak_code", "inconsistent", "outside"):
            self.assertIn(f"passed  {test}: ", text)
        dark = self.succeed("explain", "v.pcd", "--row", "0", "--col", "0").stdout
        self.assertIn("failed  low_modulation: ", dark)
        self.assertIn("miss", dark)
        self.assertIn("there is no surface", dark)
        self.assertNotIn("lights the surface", dark)

    def test_the_law_reports_the_true_depth_with_noise(self):
        self.succeed(*RENDER, "scanner.yaml", "--depth-model", "law", "-o", "v.depth.png", "--depth-scale", "10000")
        errors_mm = []
        for v, row in enumerate(self.grey_rows("v.depth.png")):
            for u, depth in enumerate(row):
                true_m = sphere_depth_m(u, v)
                self.assertEqual(depth > 0, true_m > 0, (u, v))
                if depth > 0:
                    errors_mm.append(depth * 0.1 - 1000 * true_m)
        self.assertGreater(len(errors_mm), 1000)
        self.assertLess(abs(statistics.mean(errors_mm)), 0.15)
        self.assertAlmostEqual(statistics.pstdev(errors_mm), 1.0, delta=0.1)
        self.assertIn("without images of patterns",
                      self.refused(*RENDER, "scanner.yaml", "--depth-model", "law", "-o", "w.patterns.npy"))
        self.assertFalse(Path(self.folder, "w.patterns.npy").exists())

    def test_errors_name_what_is_wrong(self):
        self.write("bad.yaml", SCANNER.replace("steps: 4", "steps: 2"))
        self.assertIn("0, or 3 to 64", self.refused(*RENDER, "bad.yaml", "-o", "v.pcd"))
        self.write("bad.yaml", SCANNER.replace("position: [-0.19403, 0, 0.04851]", "position: [0, 0, 0]"))
        self.assertIn("position of the camera", self.refused(*RENDER, "bad.yaml", "-o", "v.pcd"))
        self.write("bad.yaml", SCANNER.replace("  projector: {width: 128, height: 80, fov_x_deg: 24}\n", ""))
        self.assertIn("projector", self.refused(*RENDER, "bad.yaml", "-o", "v.pcd"))
        self.assertIn("use --renderer rays", self.refused(*RENDER, "scanner.yaml", "--renderer", "raster", "-o", "v.pcd"))
        self.assertFalse(Path(self.folder, "v.pcd").exists())

    def test_patterns_of_a_sensor_file_have_the_size_of_its_projector(self):
        done = self.succeed("depth", "structured-light", "scanner.yaml", "--patterns", "out")
        self.assertEqual(done.stdout, "wrote out/pattern_00.png to out/pattern_11.png (12 files)\n")
        self.assertEqual(struct.unpack(">II", self.bytes_of("out/pattern_03.png")[16:24]), (128, 80))


if __name__ == "__main__":
    unittest.main()
