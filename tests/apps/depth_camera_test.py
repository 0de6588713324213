#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar render of depth cameras from raw images: files, threads, traces of pixels. Needs no package."""

import ast
import cmath
import csv
import math
import re
import struct
import unittest
from pathlib import Path

from png_support import PngTest

LIGHT_M_PER_S = 299792458.0
HIT, IMAGE_BORDER = 0, 12  # docs/files/clouds.md
FOCAL_PX, BASELINE_M = 150.0, 0.05
MATCHER = ("--disparities", "48", "--box", "7", "--uniqueness", "20")  # as in the sensor file

STEREO = f"""
optics: {{width: 160, height: 96, fx: {FOCAL_PX}, fy: {FOCAL_PX}}}
wavelength_nm: 850
depth_model: physical
depth_camera:
  type: active_stereo
  baseline_m: {BASELINE_M}
  sub_rays: 2
  projector: {{origin_m: [0.025, 0, 0], dots: 6000, dot_width_deg: 0.5}}
  matcher: {{disparities: 48, box_px: 7, uniqueness_percent: 20}}
"""
FREQUENCIES_HZ = (50_000_000, 60_000_000)
TAPS = 4
TOF = f"""
optics: {{width: 40, height: 30, fov_x_deg: 50}}
wavelength_nm: 850
depth_model: physical
depth_camera:
  type: time_of_flight
  signal_electrons: 200000
  ambient_electrons: 1000
  read_noise_electrons: 10
  electrons_per_level: 4
  sub_rays: 2
  bounce_rays: 4
  decoder: {{frequencies_hz: [{FREQUENCIES_HZ[0]}, {FREQUENCIES_HZ[1]}], taps: {TAPS}, min_amplitude: 5}}
"""
ROOM = """
models:
- {model: builtin:box, size: 0.3, pose: {position: [0.05, 0, 1]}}
- {model: builtin:box, size: [8, 8, 0.2], pose: {position: [0, 0, 2.3]}}
sensor_pose: {position: [0, 0, 0]}
"""
COLUMNS = ("--columns", "range,depth,intensity,status,row,col")


def floats_of(data):
    """Shape and values of a float array in NumPy's format, by its specification."""
    size = struct.unpack_from("<H", data, 8)[0]
    header = ast.literal_eval(data[10:10 + size].decode())
    assert header["descr"] == "<f4" and not header["fortran_order"]
    return header["shape"], struct.unpack(f"<{math.prod(header['shape'])}f", data[10 + size:])


def fit_range_m(phases):
    """The range that fits the phases best, weights f^2, of all numbers of periods; by trying ranges."""
    best = (math.inf, 0.0)
    for period in range(6):  # 6 x 2.5 m: the unambiguous range of 50 and 60 MHz
        near = (phases[1] / (2 * math.pi) + period) * LIGHT_M_PER_S / (2 * FREQUENCIES_HZ[1])
        turns = []
        for phase, f_hz in zip(phases, FREQUENCIES_HZ):
            expected = near * 2 * f_hz / LIGHT_M_PER_S
            turn = phase / (2 * math.pi)
            turns.append(turn + round(expected - turn))
        total = sum(f * f for f in FREQUENCIES_HZ)
        range_m = sum(t * f for t, f in zip(turns, FREQUENCIES_HZ)) / total * LIGHT_M_PER_S / 2
        misfit = sum((t - 2 * f * range_m / LIGHT_M_PER_S)**2 for t, f in zip(turns, FREQUENCIES_HZ))
        best = min(best, (misfit, range_m))
    return best[1]


class DepthCameras(PngTest):
    def setUp(self):
        super().setUp()
        self.write("room.yaml", ROOM)
        self.write("stereo.yaml", STEREO)
        self.write("tof.yaml", TOF)

    def render(self, sensor, *outputs, options=()):
        words = [word for name in outputs for word in ("-o", name)]
        return self.succeed("render", "room.yaml", "--sensor", sensor, *options, *words, "--no-sidecar")

    def points(self, name):
        with open(Path(self.folder, name), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def explain(self, sensor, row, col):
        self.succeed("render", "room.yaml", "--sensor", sensor, *COLUMNS, "-o", "explained.csv")
        return self.succeed("explain", "explained.csv", "--row", str(row), "--col", str(col)).stdout


class StereoOutputs(DepthCameras):
    def test_the_written_images_matched_by_glidar_stereo_give_the_reported_depths(self):
        self.render("stereo.yaml", "a.ir_left.png", "a.ir_right.png", "a.depth.png", "a.csv", options=COLUMNS)
        self.succeed("depth", "stereo", "a.ir_left.png", "a.ir_right.png", *MATCHER, "-o", "disparity.npy", "--quiet")
        shape, disparity = floats_of(self.bytes_of("disparity.npy"))
        self.assertEqual(shape, (96, 160))
        depth_mm = [level for row in self.grey_rows("a.depth.png") for level in row]
        hits = 0
        for point, disparity_px, millimetres in zip(self.points("a.csv"), disparity, depth_mm, strict=True):
            if int(point["status"]) != HIT:
                self.assertEqual(millimetres, 0)
                continue
            hits += 1
            expected_mm = math.floor(FOCAL_PX * BASELINE_M / disparity_px * 1000 + 0.5)
            self.assertAlmostEqual(float(point["depth"]) * 1000, expected_mm, delta=1e-3)
            self.assertEqual(millimetres, expected_mm)
        self.assertGreater(hits, 0.6 * 160 * 96)

    def test_the_band_on_the_left_has_its_status(self):
        self.render("stereo.yaml", "a.csv", options=COLUMNS)
        # the wall is at 2.2 m: 3.4 px, plus half of the window of 7 + 6 px
        band = [int(p["status"]) for p in self.points("a.csv") if int(p["row"]) == 8 and int(p["col"]) < 8]
        self.assertEqual(set(band), {IMAGE_BORDER})

    def test_the_images_are_grey_of_8_bits_and_differ_by_the_disparity(self):
        self.render("stereo.yaml", "a.ir_left.png", "a.ir_right.png")
        for name in ("a.ir_left.png", "a.ir_right.png"):
            self.assertEqual(struct.unpack_from(">IIBB", self.bytes_of(name), 16), (160, 96, 8, 0), name)
        self.assertNotEqual(self.bytes_of("a.ir_left.png"), self.bytes_of("a.ir_right.png"))

    def test_presets_write_the_images_that_they_take(self):
        physical = ("--sensor", "D435", "--depth-model", "physical")
        self.succeed("render", "builtin:asteroid", *physical, "-o", "d.ir_left.png", "-o", "d.ir_right.png", "-o",
                     "d.depth.png", "--no-sidecar")
        self.assertEqual(struct.unpack_from(">II", self.bytes_of("d.ir_right.png"), 16), (848, 480))
        self.succeed("render", "builtin:asteroid", "--sensor", "Kinect-v1", "--depth-model", "physical", "-o",
                     "k.ir_left.png", "-o", "k.ir_reference.png", "--no-sidecar")
        self.assertEqual(self.files(), ["d.depth.png", "d.ir_left.png", "d.ir_right.png", "k.ir_left.png",
                                        "k.ir_reference.png", "room.yaml", "stereo.yaml", "tof.yaml"])

    def test_the_model_law_has_noise_steps_in_place_of_images(self):
        self.render("stereo.yaml", "law.csv", options=("--depth-model", "law", *COLUMNS))
        statuses = {int(p["status"]) for p in self.points("law.csv")}
        self.assertEqual(statuses, {HIT})


class TofOutputs(DepthCameras):
    def test_the_written_raw_images_have_the_reported_ranges(self):
        self.render("tof.yaml", "a.tof.npy", "a.ir.png", "a.depth.png", "a.csv", options=COLUMNS)
        shape, raw = floats_of(self.bytes_of("a.tof.npy"))
        self.assertEqual(shape, (2, TAPS, 30, 40))
        pixels, hits = 30 * 40, 0
        amplitudes = [level for row in self.grey_rows("a.ir.png") for level in row]
        for i, point in enumerate(self.points("a.csv")):
            phasors = [2 / TAPS * sum(raw[(f * TAPS + k) * pixels + i] * cmath.exp(2j * math.pi * k / TAPS)
                                      for k in range(TAPS)) for f in range(2)]
            mean = sum(abs(z) for z in phasors) / 2
            self.assertAlmostEqual(amplitudes[i], mean, delta=0.5 + 1e-6 * mean)  # rounded; the mean is a float
            if int(point["status"]) != HIT:
                continue
            hits += 1
            range_m = fit_range_m([cmath.phase(z) % (2 * math.pi) for z in phasors])
            self.assertAlmostEqual(float(point["range"]), range_m, delta=1e-5)  # of the decimals in the file
            self.assertAlmostEqual(float(point["intensity"]), mean, delta=1e-4 * mean)
        self.assertGreater(hits, 0.9 * pixels)

    def test_the_preset_writes_its_raw_images(self):
        self.succeed("render", "builtin:asteroid", "--sensor", "Kinect-v2", "--depth-model", "physical", "-o", "k.ir.png",
                     "-o", "k.tof.npy", "-o", "k.depth.png", "--no-sidecar")
        shape, _ = floats_of(self.bytes_of("k.tof.npy"))
        self.assertEqual(shape, (3, 3, 424, 512))
        self.assertEqual(struct.unpack_from(">IIBB", self.bytes_of("k.ir.png"), 16), (512, 424, 16, 0))


class Determinism(DepthCameras):
    def outputs_of(self, sensor, suffixes, *options):
        names = [f"x.{suffix}" for suffix in suffixes]
        self.render(sensor, *names, options=(*COLUMNS, *options))
        return [self.bytes_of(name) for name in names]

    def test_threads_and_renderers_do_not_change_the_bytes(self):
        for sensor, suffixes in (("stereo.yaml", ("ir_left.png", "ir_right.png", "csv")),
                                 ("tof.yaml", ("tof.npy", "ir.png", "csv"))):
            expected = self.outputs_of(sensor, suffixes, "--threads", "1", "--renderer", "rays")
            for threads in ("2", "7"):
                for renderer in ("rays", "auto"):
                    with self.subTest(sensor=sensor, threads=threads, renderer=renderer):
                        found = self.outputs_of(sensor, suffixes, "--threads", threads, "--renderer", renderer)
                        self.assertEqual(found, expected)

    def test_another_seed_gives_other_noise_and_the_same_seed_the_same(self):
        for sensor, suffixes in (("stereo.yaml", ("ir_left.png", "ir_right.png", "csv")), ("tof.yaml", ("tof.npy", "csv"))):
            first, again, other = (self.outputs_of(sensor, suffixes, "--seed", seed) for seed in ("4", "4", "5"))
            self.assertEqual(first, again)
            for a, b in zip(first, other):
                self.assertNotEqual(a, b, sensor)

    def test_instruction_sets_do_not_change_the_bytes(self):
        expected = self.outputs_of("stereo.yaml", ("ir_left.png", "csv"))
        self.environment["GLIDAR_ISA"] = "baseline"
        self.assertEqual(self.outputs_of("stereo.yaml", ("ir_left.png", "csv")), expected)


class Traces(DepthCameras):
    def test_a_stereo_pixel_is_explained_by_its_images(self):
        self.render("stereo.yaml", "a.ir_left.png", "a.csv", options=COLUMNS)
        row = 48
        point = next(p for p in self.points("a.csv")
                     if int(p["row"]) == row and int(p["col"]) >= 60 and int(p["status"]) == HIT)  # fmt: skip
        col = int(point["col"])
        text = self.explain("stereo.yaml", row, col)
        level = int(re.search(r"read noise [-+0-9.]+: grey (\d+)", text)[1])
        self.assertEqual(level, self.grey_rows("a.ir_left.png")[row][col])
        disparity_px = float(re.search(r"(?m)^ +disparity ([0-9.]+)", text)[1])
        self.assertAlmostEqual(float(point["depth"]), math.floor(FOCAL_PX * BASELINE_M / disparity_px * 1000 + 0.5) / 1000,
                               delta=2e-6)
        true_px = float(re.search(r"true disparity ([0-9.]+) px", text)[1])
        true_depth_m = float(re.search(r"depth ([0-9.]+) m, incidence", text)[1])
        self.assertAlmostEqual(true_px, FOCAL_PX * BASELINE_M / true_depth_m, delta=6e-5)  # of its decimals
        self.assertIn(f"reported  {float(point['range']):.6f} m", text)
        self.assertEqual(text.count("  passed  "), 6)

    def test_a_time_of_flight_pixel_is_explained_by_its_raw_images(self):
        self.render("tof.yaml", "a.tof.npy", "a.csv", options=COLUMNS)
        row, col = 15, 20
        point = next(p for p in self.points("a.csv") if (int(p["row"]), int(p["col"])) == (row, col))
        self.assertEqual(int(point["status"]), HIT)
        text = self.explain("tof.yaml", row, col)
        _, raw = floats_of(self.bytes_of("a.tof.npy"))
        for f, mhz in enumerate(("50.000", "60.000")):
            listed = re.search(rf"{re.escape(mhz)} MHz: raw ([-0-9. ]+);", text)[1].split()
            own = [raw[(f * TAPS + k) * 1200 + row * 40 + col] for k in range(TAPS)]
            self.assertEqual(listed, [f"{value:.1f}" for value in own])
        self.assertIn(f"reported  {float(point['range']):.6f} m", text)
        share = float(re.search(r"([0-9.]+) % of the illuminator's light came over diffuse bounces", text)[1])
        self.assertTrue(0.0 <= share < 50.0)


if __name__ == "__main__":
    unittest.main()
