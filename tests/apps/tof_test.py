#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar depth tof: decoded files beside those of the simulation, the trace of a pixel, errors."""

import math
import re
import struct
import unittest
from pathlib import Path

from png_support import PngTest

SAMPLE = ("depth", "tof", "builtin:disc")
WIDTH, HEIGHT, TAPS = 24, 16, 4
SENSOR = f"""
name: test camera
optics: {{width: {WIDTH}, height: {HEIGHT}, fov_x_deg: 50}}
wavelength_nm: 850
limits: {{near_m: 0.3, far_m: 6}}
depth_model: physical
depth_camera:
  type: time_of_flight
  signal_electrons: 200000
  electrons_per_level: 10
  read_noise_electrons: 10
  bounces: 0
  decoder: {{frequencies_hz: [50e6, 60e6], taps: {TAPS}, min_amplitude: 5, edge_test: {{}}}}
"""


CODES = {"<f2": "e", "<f4": "f", "<f8": "d", "|i1": "b", "|u1": "B", "<i2": "h", "<u2": "H", "<i4": "i", "<u4": "I", "<i8": "q",
         "<u8": "Q"}  # of struct


def npy(shape, values, kind="<f4", version=1):
    """A NumPy array file, by its specification."""
    head = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {tuple(shape)!r}, }}".encode()
    size = struct.pack("<H" if version == 1 else "<I", len(head))
    return b"\x93NUMPY" + bytes([version, 0]) + size + head + struct.pack(f"<{len(values)}{CODES[kind]}", *values)


class TofCommand(PngTest):
    def setUp(self):
        super().setUp()
        self.write("s.yaml", SENSOR)
        self.write("room.yaml", "models: [{model: builtin:box, size: 8, pose: {position: [0, 0, 2]}}, "
                                "{model: builtin:box, size: 0.5, pose: {position: [0, 0, 1.5]}}]\nsensor_pose: {position: [0, 0, 0]}\n")

    def store_bytes(self, name, data):
        Path(self.folder, name).write_bytes(data)

    def floats(self, name, count):
        return struct.unpack(f"<{count}f", self.bytes_of(name)[-4 * count:])

    def test_raw_images_of_a_simulation_have_its_depths(self):
        self.succeed("render", "room.yaml", "--sensor", "s.yaml", "-o", "a.tof.npy", "-o", "a.npy", "-o", "a.depth.png", "-o",
                     "a.ir.png", "--no-sidecar")
        names = [quantity + suffix for quantity in ("depth", "range", "amplitude", "status") for suffix in (".npy", ".png")]
        done = self.succeed("depth", "tof", "a.tof.npy", "--sensor", "s.yaml", *(word for name in names for word in ("-o", name)))
        self.assertRegex(done.stdout, rf"^{WIDTH}x{HEIGHT} pixels: \d+\.\d % valid")
        pixels = WIDTH * HEIGHT
        simulated, decoded = self.floats("a.npy", pixels), self.floats("depth.npy", pixels)
        for one, other in zip(simulated, decoded, strict=True):
            self.assertEqual(math.isnan(one), math.isnan(other))
            if not math.isnan(one):
                self.assertAlmostEqual(one, other, delta=1e-6)
        self.assertGreater(sum(not math.isnan(v) for v in decoded), 0.6 * pixels)
        self.assertEqual(self.grey_rows("depth.png"), self.grey_rows("a.depth.png"))
        self.assertEqual(self.grey_rows("amplitude.png"), self.grey_rows("a.ir.png"))
        for one, other in zip(decoded, self.floats("range.npy", pixels)):
            self.assertTrue(math.isnan(one) or one <= other)

    def test_a_preset_with_a_lens_has_the_depths_of_its_simulation(self):
        self.succeed("render", "builtin:asteroid", "--sensor", "Kinect-v2", "--depth-model", "physical", "-o", "k.tof.npy", "-o",
                     "k.depth.png", "--no-sidecar")
        self.succeed("depth", "tof", "k.tof.npy", "--sensor", "Kinect-v2", "-o", "depth.png")
        pairs = [pair for rows in zip(self.grey_rows("depth.png"), self.grey_rows("k.depth.png"), strict=True)
                 for pair in zip(*rows, strict=True)]
        others = [abs(a - b) for a, b in pairs if a != b]
        self.assertGreater(sum(b > 0 for _, b in pairs), 10_000)
        self.assertLess(len(others), 0.001 * len(pairs))  # cosines of the decoder are floats, so a few round otherwise
        self.assertTrue(all(difference == 1 for difference in others))

    def test_the_sample_has_every_cause_of_its_page(self):
        done = self.succeed(*SAMPLE, "-o", "range.npy", "-o", "status.npy")
        for cause in ("valid", "not_illuminated", "saturated", "low_signal", "too_far", "edge"):
            self.assertIn(f" % {cause}", done.stdout)
        status = self.bytes_of("status.npy")[-160 * 120:]
        for number, range_m in zip(status, self.floats("range.npy", 160 * 120), strict=True):
            self.assertEqual(number == 0, not math.isnan(range_m))

    def test_explains_a_pixel(self):
        text = self.succeed(*SAMPLE, "--explain", "49,56").stdout
        self.assertIn("passed  low_signal", text)
        self.assertIn("failed  edge", text)
        self.assertRegex(text, r"80\.000 MHz: raw -?\d")

    def test_threads_do_not_change_the_bytes(self):
        for threads in ("1", "2", "7"):
            self.succeed(*SAMPLE, "--threads", threads, "-o", f"{threads}_range.npy")
        self.assertEqual(self.bytes_of("1_range.npy"), self.bytes_of("2_range.npy"))
        self.assertEqual(self.bytes_of("1_range.npy"), self.bytes_of("7_range.npy"))

    def test_doubles_and_the_second_version_of_the_format_are_read(self):
        values = [100 * math.cos(0.4 * f + 0.1 * p - math.pi / 2 * k) for f in (1, 2) for k in range(TAPS)
                  for p in range(WIDTH * HEIGHT)]
        shape = (2, TAPS, HEIGHT, WIDTH)
        for name, data in (("a", npy(shape, values)), ("b", npy(shape, values, "<f8")), ("c", npy(shape, values, version=2))):
            self.store_bytes(f"{name}.npy", data)
            self.succeed("depth", "tof", f"{name}.npy", "--sensor", "s.yaml", "-o", f"{name}_status.npy", "-o", f"{name}_amplitude.npy")
        for name in "bc":
            self.assertEqual(self.bytes_of(f"{name}_status.npy"), self.bytes_of("a_status.npy"))
            self.assertEqual(self.bytes_of(f"{name}_amplitude.npy"), self.bytes_of("a_amplitude.npy"))

    def test_images_of_every_real_type_have_the_same_ranges(self):
        values = [round(60 + 50 * math.cos(0.4 * f + 0.1 * p - math.pi / 2 * k)) for f in (1, 2) for k in range(TAPS)
                  for p in range(WIDTH * HEIGHT)]  # exact in each type
        for sign in (1, -1):
            results = set()
            for kind in CODES:
                if sign < 0 and "u" in kind:
                    continue
                self.store_bytes("a.npy", npy((2, TAPS, HEIGHT, WIDTH), [sign * value for value in values], kind))
                self.succeed("depth", "tof", "a.npy", "--sensor", "s.yaml", "-o", "amplitude.npy", "-o", "range.npy")
                results.add(self.bytes_of("amplitude.npy") + self.bytes_of("range.npy"))
            self.assertEqual(len(results), 1)

    def test_halves_may_be_tiny_or_infinite(self):
        self.write("plain.yaml", re.sub("min_amplitude: 5, edge_test: {}", "min_amplitude: 0", SENSOR))
        tiny = [math.ldexp(1 + k, -24) for k in range(TAPS) for _ in range(WIDTH * HEIGHT)] * 2  # subnormal
        tiny[0], tiny[1] = math.inf, -math.inf
        for kind in ("<f2", "<f4"):
            self.store_bytes("a.npy", npy((2, TAPS, HEIGHT, WIDTH), tiny, kind))
            self.succeed("depth", "tof", "a.npy", "--sensor", "plain.yaml", "-o", f"{kind[1:]}_amplitude.npy", "-o", f"{kind[1:]}_status.npy")
        self.assertEqual(self.bytes_of("f2_status.npy")[-WIDTH * HEIGHT:][:2], b"\2\2")
        for name in ("amplitude.npy", "status.npy"):
            self.assertEqual(self.bytes_of(f"f2_{name}"), self.bytes_of(f"f4_{name}"))

    def test_bad_raw_images_are_errors(self):
        good = npy((2, TAPS, HEIGHT, WIDTH), [1.0] * (2 * TAPS * HEIGHT * WIDTH))
        cases = {
            "cut": (good[:-4], "fewer numbers than its shape requires"),
            "head": (good[:40], "the file ends in its head"),
            "text": (b"no array", "no NumPy array"),
            "empty": (b"", "no NumPy array"),
            "complex": (good.replace(b"<f4", b"<c8"), "allowed: floats of 16 to 64 bits or integers, little-endian, row by row"),
            "big": (good.replace(b"<f4", b">f4"), "little-endian"),
            "columns": (good.replace(b"'fortran_order': False", b"'fortran_order': True "), "row by row"),
            "flat": (npy((HEIGHT, WIDTH), [1.0] * (HEIGHT * WIDTH)), "allowed: frequencies x phase steps x rows x columns"),
            "deep": (npy((1, 2, TAPS, HEIGHT, WIDTH), [1.0] * (2 * TAPS * HEIGHT * WIDTH)), "an array of another shape"),
            "none": (npy((2, TAPS, 0, WIDTH), []), "an array of another shape"),
            "vast": (npy((2**40, 2**40, 2**40, 2**40), [1.0]), "fewer numbers than its shape requires"),
            "small": (npy((2, TAPS, HEIGHT, 8), [1.0] * (2 * TAPS * HEIGHT * 8)), "has 8x16 pixels, the sensor 'test camera' 24x16"),
            "steps": (npy((2, 3, HEIGHT, WIDTH), [1.0] * (6 * HEIGHT * WIDTH)), "2 frequencies with 3 phase steps"),
        }
        for name, (data, words) in cases.items():
            self.store_bytes(f"{name}.npy", data)
            with self.subTest(name):
                self.assertIn(words, self.refused("depth", "tof", f"{name}.npy", "--sensor", "s.yaml", "-o", "depth.npy"))
        self.assertIn("missing.npy", self.refused("depth", "tof", "missing.npy", "--sensor", "s.yaml", "-o", "depth.npy"))

    def test_bad_options_are_errors(self):
        self.store_bytes("a.npy", npy((2, TAPS, HEIGHT, WIDTH), [1.0] * (2 * TAPS * HEIGHT * WIDTH)))
        raw, output = ("depth", "tof", "a.npy"), ("-o", "depth.npy")
        cases = {
            "add --sensor": (*raw, *output), "leave --sensor out": (*SAMPLE, *output, "--sensor", "Kinect-v2"),
            "is no time-of-flight camera": (*raw, *output, "--sensor", "D435"),
            "neither -o nor --explain": SAMPLE, "its name does not state what to write": (*SAMPLE, "-o", "result.png"),
            "400,3 is outside the image": (*SAMPLE, *output, "--explain", "400,3"), "COLUMN,ROW": (*SAMPLE, "--explain", "4"),
            "--depth-unit-mm": (*SAMPLE, *output, "--depth-unit-mm", "nan")}
        for words, arguments in cases.items():
            with self.subTest(words):
                self.assertIn(words, self.refused(*arguments))

    def test_inputs_are_not_overwritten(self):
        data = npy((2, TAPS, HEIGHT, WIDTH), [1.0] * (2 * TAPS * HEIGHT * WIDTH))
        self.store_bytes("depth.npy", data)
        self.refused("depth", "tof", "depth.npy", "--sensor", "s.yaml", "-o", "depth.npy")
        self.assertEqual(self.bytes_of("depth.npy"), data)
        self.write("range.npy", SENSOR)
        self.assertIn("range.npy: is an input file, or another output writes it",
                      self.refused("depth", "tof", "depth.npy", "--sensor", "range.npy", "-o", "range.npy"))
        self.assertEqual(self.bytes_of("range.npy").decode(), SENSOR)


if __name__ == "__main__":
    unittest.main()
