# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A depth camera of the RealSense's kind, recorded before an object whose CAD model and pose are known, against
what the program renders of it. Exits with 77 (skipped) where the data, numpy or Pillow are missing."""

import json
import os
import unittest
from pathlib import Path

from cli_support import CliTest
from skipping import importing, skip

with importing():
    import numpy as np
    from PIL import Image

DATA = os.environ.get("GLIDAR_DATA")
if not DATA:
    skip("GLIDAR_DATA is not set", "set it to a folder with real data")

RECORDING = Path(DATA) / "recordings/m3t_realsense"
# _sequence/depth_camera.yaml: pixel centres at whole numbers, and the depth camera in the colour camera's frame
OPTICS = "{width: 848, height: 480, fx: 425.773, fy: 425.773, cx: 427.202, cy: 237.662, pixel_centre: 0}"
COLOUR_FROM_DEPTH = np.array([[0.99985489, 0.00778240, 0.01509715, 0.01453388],
                              [-0.00782678, 0.99996543, 0.00288261, 0.00013995],
                              [-0.01507424, -0.00300036, 0.99988175, 0.00051057],
                              [0, 0, 0, 1]])
SIDE = 9  # of patches, in pixels


def bottle_pose():
    """The bottle's place and quaternion w x y z in the depth camera's frame."""
    with open(Path(DATA) / "reference/m3t_opengl/params.json", encoding="utf-8") as file:
        body = json.load(file)["bodies"]["schauma"]
    pose = np.linalg.inv(np.array(body["world2body"]) @ COLOUR_FROM_DEPTH) @ np.array(body["geometry2body"])
    left, _, right = np.linalg.svd(pose[:3, :3])
    r = left @ right
    w = 0.5 * np.sqrt(1.0 + np.trace(r))
    return pose[:3, 3], [w, (r[2, 1] - r[1, 2]) / (4 * w), (r[0, 2] - r[2, 0]) / (4 * w),
                         (r[1, 0] - r[0, 1]) / (4 * w)]


def recorded_depth_m(frame):
    counts = np.asarray(Image.open(RECORDING / f"_sequence/depth_camera_image_{frame}.png")).astype(float)
    return np.where((counts > 0) & (counts < 65535), counts / 1000.0, np.nan)


def spread_by_depth(depth_m):
    """Median spread of 1 / depth about planes through patches, in 1/m, by decimetres of depth."""
    y, x = np.mgrid[:SIDE, :SIDE]
    plane = np.c_[np.ones(SIDE * SIDE), y.ravel(), x.ravel()]
    residual = np.eye(SIDE * SIDE) - plane @ np.linalg.pinv(plane)
    spreads = {}
    for row in range(0, depth_m.shape[0] - SIDE, 6):
        for col in range(0, depth_m.shape[1] - SIDE, 6):
            patch = 1.0 / depth_m[row:row + SIDE, col:col + SIDE].ravel()
            if np.isnan(patch).any():
                continue
            left = residual @ patch
            spreads.setdefault(round(10.0 / np.median(patch)), []).append(
                np.sqrt(left @ left / (SIDE * SIDE - 3)))
    return {depth: np.median(values) for depth, values in spreads.items() if len(values) > 60}


class RealSense(CliTest):
    def render(self, model, sensor):
        self.write("scene.yaml", f"models: [{model}]\nsensor: {sensor}\nsensor_pose: {{position: [0, 0, 0]}}\n")
        self.succeed("render", "scene.yaml", "-o", "depth.npy", "--quiet")
        return np.load(os.path.join(self.folder, "depth.npy")).astype(float)

    def test_the_recording_shows_the_model_at_the_simulated_pixels(self):
        position, (w, x, y, z) = bottle_pose()
        model = RECORDING / "_body/schauma.obj"
        depth_m = self.render(f"{{model: '{model}', pose: {{position: {position.tolist()}, "
                              f"orientation: {{w: {w}, x: {x}, y: {y}, z: {z}}}}}}}", f"{{optics: {OPTICS}}}")
        # by an independent ray caster: pixels of the model, and those of them that the camera measured
        self.assertEqual(np.isfinite(depth_m).sum(), 9769)
        for frame, measured, median_mm, within in ((200, 9132, -3.4, 0.954), (201, 9191, -2.7, 0.946)):
            error_mm = 1e3 * (recorded_depth_m(frame) - depth_m)
            error_mm = error_mm[np.isfinite(error_mm)]
            self.assertEqual(error_mm.size, measured)
            self.assertAlmostEqual(float(np.median(error_mm)), median_mm, 1)
            self.assertAlmostEqual(float((abs(error_mm) < 10).mean()), within, 3)

    def test_the_preset_has_at_least_the_noise_of_the_recording(self):
        # Much of an error that neighbouring pixels share, as a stereo camera's do, goes into the plane. The preset's
        # pixels have errors of their own: by this estimator it may be up to 2.5 times as noisy.
        recorded = spread_by_depth(recorded_depth_m(200))
        self.assertGreater(len(recorded), 8)
        for decimetres in (5, 11, 20):
            depth_m = self.render(f"{{model: builtin:plane, pose: {{position: [0, 0, {decimetres / 10}]}}, scale: 9}}",
                                  "D435")
            reported = spread_by_depth(depth_m)[decimetres]
            self.assertAlmostEqual(reported, 0.003587, 4)  # 3.587 mm z^2
            self.assertGreater(reported, recorded[decimetres])
            self.assertLess(reported, 2.5 * recorded[decimetres])


if __name__ == "__main__":
    unittest.main()
