#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Calibrations of single sensors, and images of cameras that look back. The built program is found in PATH."""

import json
import os
import unittest

import numpy as np
from png_support import PngTest

ROOM = ("builtin:box:size=20,16,6", "--eye", "1,2,0", "--ground-truth")
PANORAMA = "optics: {type: pinhole, width: 48, height: 24, distortion: {model: equirectangular}}\n"
CAMCHAIN = """cam0:
  camera_model: ds
  distortion_model: none
  intrinsics: [-0.18, 0.59, 155.0, 155.5, 160.2, 119.1]
  resolution: [320, 240]
cam1:
  camera_model: omni
  distortion_model: radtan
  distortion_coeffs: [-0.2, 0.05, 0.001, -0.002]
  intrinsics: [1.2, 50.0, 51.0, 33.0, 25.0]
  resolution: [66, 50]
  T_cn_cnm1: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
"""


def velodyne_calibration():
    """A VLP-16 whose lasers have all corrections."""
    rows = []
    for i in range(16):
        degrees = -15 + i if i % 2 == 0 else i
        rows.append(
            f"- {{laser_id: {i}, rot_correction: {0.002 * i - 0.01}, vert_correction: {np.radians(degrees)}, "
            f"dist_correction: {0.1 + 0.01 * i}, vert_offset_correction: 0.01, horiz_offset_correction: 0.02}}\n"
        )
    return "num_lasers: 16\ndistance_resolution: 0.002\nlasers:\n" + "".join(rows)


class Calibrated(PngTest):
    def arrays(self, name):
        with np.load(os.path.join(self.folder, name)) as stored:
            return {key: stored[key] for key in stored.files}


class Lidars(Calibrated):
    def test_packets_of_a_calibrated_sensor_decode_to_its_clouds(self):
        self.write("c.yaml", velodyne_calibration())
        sensor = ("--sensor", "VLP-16", "--calibration", "c.yaml")
        self.succeed("render", *ROOM, *sensor, "--columns", "xyz,range", "-o", "true.npz", "-o", "scan.pcap")
        self.succeed("decode", "scan.pcap", *sensor, "-o", "found.npz")
        true, found = self.arrays("true.npz"), self.arrays("found_000000.npz")
        cols = min(true["range"].shape[1], found["range"].shape[1])
        difference = true["range"][:, :cols] - found["range"][:, :cols]
        valid = np.isfinite(difference)
        self.assertGreater(valid.mean(), 0.95)
        self.assertLessEqual(np.abs(difference[valid]).max(), 0.001001)
        self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "-o", "raw.npz")
        shift = self.arrays("raw_000000.npz")["range"][:, :cols] - true["range"][:, :cols]
        rows = np.nanmean(shift, axis=1)  # the packets have the range minus the correction; the highest beam first
        lasers = [15, 13, 11, 9, 7, 5, 3, 1, 14, 12, 10, 8, 6, 4, 2, 0]
        np.testing.assert_allclose(rows, [-0.1 - 0.01 * i for i in lasers], atol=1e-3)

    def test_old_metadata_of_ouster_are_completed_with_a_note(self):
        angles = [10.0, 3.0, -4.0]
        self.write("m.json", json.dumps({"lidar_mode": "512x10", "prod_line": "OS-1-64", "beam_altitude_angles": angles,
                                         "beam_azimuth_angles": angles}))  # fmt: skip
        self.write("s.yaml", "optics: {type: ouster, file: m.json}\n")
        done = self.succeed("render", *ROOM, "--sensor", "s.yaml", "-o", "a.npz")
        self.assertIn("m.json: no lidar_origin_to_beam_origin_mm: 15.806 mm, the manufacturer's default", done.stderr)
        self.assertEqual(self.arrays("a.npz")["xyz"].shape, (3, 512, 3))
        quiet = self.succeed("render", *ROOM, "--sensor", "s.yaml", "-o", "b.npz", "--quiet")
        self.assertEqual(quiet.stderr, "")

    def test_calibrations_that_do_not_fit_write_nothing(self):
        self.write("c.yaml", velodyne_calibration())
        reported = self.refused("render", *ROOM, "--sensor", "VLP-32C", "--calibration", "c.yaml", "-o", "a.npz")
        self.assertIn("c.yaml: num_lasers: 16 channels; allowed: 32, as the sensor", reported)
        reported = self.refused("render", *ROOM, "--sensor", "VLP-16", "--calibration", "none.yaml", "-o", "a.npz")
        self.assertIn("none.yaml: no such file", reported)
        reported = self.refused("render", *ROOM, "--calibration", "c.yaml", "-o", "a.npz")
        self.assertIn("--calibration: there is no --sensor", reported)
        self.assertEqual(self.files(), ["c.yaml"])


class Scenes(Calibrated):
    def elevations(self, *arguments):
        self.succeed("render", *arguments, "--ground-truth", "--columns", "xyz,range", "-o", "a.npz")
        cloud = self.arrays("a.npz")
        return np.degrees(np.arcsin(cloud["xyz"][..., 2] / cloud["range"]))[:, 0]

    def test_the_calibration_of_a_scenes_sensor_is_in_the_scene_or_an_option(self):
        self.write("c.csv", "Channel,Elevation,Azimuth\n1,-3,0\n2,7,0\n")
        sensor = "sensor: {optics: {type: spinning, columns_per_turn: 8, elevation_deg: [0, 1]}}\n"
        room = "models: [{model: builtin:box}]\nsensor_pose: {position: [0, 0, 0]}\n" + sensor
        self.write("plain.yaml", room)
        self.write("own.yaml", room + "sensor_calibration_file: c.csv\n")
        np.testing.assert_allclose(self.elevations("plain.yaml"), [1, 0], atol=1e-4)
        np.testing.assert_allclose(self.elevations("own.yaml"), [7, -3], atol=1e-4)
        np.testing.assert_allclose(self.elevations("plain.yaml", "--calibration", "c.csv"), [7, -3], atol=1e-4)
        self.write("rig.yaml", "models: [{model: builtin:box}]\nsensors: [{name: a, sensor: VLP-16}]\n")
        reported = self.refused("render", "rig.yaml", "--calibration", "c.csv", "-o", "b.npz")
        self.assertIn("--calibration: given for a scene file with a rig of sensors", reported)
        self.assertIn("calibration_file: ...", reported)


class Cameras(Calibrated):
    def test_kalibr_selects_a_camera_by_its_name(self):
        self.write("camchain.yaml", CAMCHAIN)
        self.write("a.yaml", "optics: {type: pinhole, calibration_file: camchain.yaml}\n")
        self.write("b.yaml", "optics: {type: pinhole, calibration_file: 'camchain.yaml#cam1'}\n")
        self.succeed("render", *ROOM, "--sensor", "a.yaml", "-o", "a.npz")
        done = self.succeed("render", *ROOM, "--sensor", "b.yaml", "-o", "b.npz", "-o", "b.npy")
        self.assertIn("camchain.yaml: cam1: not used: T_cn_cnm1", done.stderr)
        self.assertEqual(self.arrays("a.npz")["xyz"].shape, (240, 320, 3))
        self.assertEqual(self.arrays("b.npz")["xyz"].shape, (50, 66, 3))
        with open(os.path.join(self.folder, "b.glidar.json"), encoding="utf-8") as file:
            info = json.load(file)["sensor"]["camera_info"]
        self.assertEqual(info["distortion_model"], "omni")
        self.assertEqual(info["d"], [1.2, -0.2, 0.05, 0.001, -0.002])
        reported = self.refused("render", *ROOM, "--sensor", "b.yaml", "--calibration", "camchain.yaml#cam2", "-o", "c.npz")
        self.assertIn("cam2", reported)

    def test_ros_calibrations_have_opencvs_coefficients(self):
        self.write("left.yaml", "image_width: 64\nimage_height: 48\ncamera_name: left\ndistortion_model: plumb_bob\n"
                   "camera_matrix: {rows: 3, cols: 3, data: [60, 0.5, 31, 0, 61, 23, 0, 0, 1]}\n"
                   "distortion_coefficients: {rows: 1, cols: 5, data: [-0.2, 0.1, 0.001, -0.002, 0.01]}\n")  # fmt: skip
        self.write("s.yaml", "optics: {type: pinhole, calibration_file: left.yaml}\n")
        self.succeed("render", *ROOM, "--sensor", "s.yaml", "-o", "a.npy")
        with open(os.path.join(self.folder, "a.glidar.json"), encoding="utf-8") as file:
            info = json.load(file)["sensor"]["camera_info"]
        self.assertEqual((info["distortion_model"], info["d"]), ("plumb_bob", [-0.2, 0.1, 0.001, -0.002, 0.01]))
        self.assertEqual(info["k"], [60, 0.5, 31, 0, 61, 23, 0, 0, 1])

    def test_calibrations_with_distortion_are_refused_for_stereo_cameras(self):
        calibration = ("image_width: 640\nimage_height: 480\ncamera_name: left\ndistortion_model: plumb_bob\n"
                       "camera_matrix: {{rows: 3, cols: 3, data: [600, 0, 320, 0, 600, 240, 0, 0, 1]}}\n"
                       "distortion_coefficients: {{rows: 1, cols: 5, data: [{}, 0, 0, 0, 0]}}\n")
        self.write("distorted.yaml", calibration.format(-0.2))
        self.write("rectified.yaml", calibration.format(0))
        reported = self.refused("render", *ROOM, "--sensor", "D435", "--calibration", "distorted.yaml", "-o", "a.npy")
        self.assertIn("the optics have a lens distortion", reported)
        self.succeed("render", *ROOM, "--sensor", "D435", "--calibration", "rectified.yaml", "-o", "a.npy")

    def test_images_of_cameras_that_look_back_have_ranges(self):
        self.write("s.yaml", PANORAMA)
        self.succeed("render", *ROOM, "--sensor", "s.yaml", "--columns", "range,depth", "-o", "a.npz", "-o", "a.npy",
                     "-o", "a.depth.png", "-o", "a.depth.tiff", "-o", "a.png")  # fmt: skip
        ranges = self.arrays("a.npz")["range"].astype(float)
        self.assertTrue(np.isfinite(ranges).all())
        self.assertLess(self.arrays("a.npz")["depth"].min(), -5.0)
        np.testing.assert_array_equal(np.load(os.path.join(self.folder, "a.npy")), ranges.astype(np.float32))
        np.testing.assert_array_equal(np.array(self.grey_rows("a.depth.png")), np.round(ranges * 1000))
        files = {one["file"]: one for one in json.loads(self.bytes_of("a.glidar.json"))["files"]}
        for name in ("a.npy", "a.depth.png", "a.depth.tiff"):
            self.assertTrue(files[name]["image"]["pixels"].startswith("range along the beam "), name)


if __name__ == "__main__":
    unittest.main()
