#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/lidar_odometry.py, shortened: drift with and without deskewing, its trajectories' errors and files."""

import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples"))
sys.path.insert(0, str(ROOT / "tests/support"))
from skipping import importing

with importing():
    import kiss_icp  # noqa: F401
    import matplotlib  # noqa: F401
    import glidar  # noqa: F401

import lidar_odometry as study
import numpy as np
import study_tools as tools
from odometry_pictures import draw

import glidar

SECONDS = 3.0
# Over 20 s KISS-ICP is off by 2 % of the way without deskewing, by 1.2 % with its own and by 1 % with the ground truth's
# (docs/studies.md). Three seconds vary by a half; a turn's motion itself is 10 % of a second's way.
LARGEST_DRIFT_PERCENT = 4.0


class Odometry(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sensor = glidar.load_sensor("VLP-16")
        cls.scans, cls.trajectory = study.drive(study.street(), cls.sensor, SECONDS)
        cls.runs = {name: study.odometry(name, cls.scans, cls.trajectory, cls.sensor.rate_hz) for name in study.RUNS}

    def test_drifts_by_a_few_percent_at_most(self):
        for name, run in self.runs.items():
            self.assertLess(run.drift_percent, LARGEST_DRIFT_PERCENT, name)

    def test_deskewing_is_better_than_none_and_the_truths_is_best(self):
        none, own, truth = (self.runs[name].drift_percent for name in study.RUNS)
        self.assertLess(own, none)
        self.assertLess(truth, none)

    def test_scans_are_distorted_by_what_the_sensor_moves_in_a_turn(self):
        # A point seen at the end of the turn is off by the distance driven in that turn: 0.9 m, and more where the road
        # bends.
        scan = self.scans[10]
        late = scan.phase > 0.9
        way = study.SPEED_M_S / self.sensor.rate_hz
        moved = np.linalg.norm(scan.xyz - scan.deskewed, axis=1)[late]
        self.assertGreater(np.median(moved), 0.7 * way)
        self.assertLess(np.abs(scan.xyz - scan.deskewed)[scan.phase < 0.01].max(), 0.1 * way)

    def test_the_picture_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder, "odometry.png")
            draw(list(self.runs.values()), self.scans, picture)
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

    def test_files_hold_the_trajectories_and_scans(self):
        with tempfile.TemporaryDirectory() as folder:
            runs = list(self.runs.values())
            study.write(Path(folder), runs, self.scans[:2])
            tum = np.loadtxt(Path(folder, "truth_of_no_deskewing.tum"))
            np.testing.assert_allclose(tum[:, 1:4], runs[0].truth[:, :3, 3], atol=1e-8)
            np.testing.assert_allclose(tum[:, 0], runs[0].times_s, atol=1e-9)
            again = glidar.Trajectory.load(Path(folder, "truth_of_no_deskewing.tum"))
            np.testing.assert_allclose(again.pose_at(runs[0].times_s[5]), runs[0].truth[5], atol=1e-7)
            kitti = np.loadtxt(Path(folder, "deskewed_by_the_ground_truth.kitti")).reshape(-1, 3, 4)
            errors = np.linalg.norm(kitti[:, :, 3] - runs[2].truth[:, :3, 3], axis=1)
            np.testing.assert_allclose(errors, runs[2].errors_m, atol=1e-5)
            points = np.fromfile(Path(folder, "000001.bin"), "<f4").reshape(-1, 4)
            np.testing.assert_allclose(points[:, :3], self.scans[1].xyz, atol=1e-4)


class Errors(unittest.TestCase):
    def test_a_trajectory_that_is_moved_as_a_whole_has_none(self):
        truth = study.route(np.arange(0, 5, 0.1))
        moved = tools.displaced([0.3, -0.2, 1.0], [5, 6, 7]) @ truth
        np.testing.assert_allclose(tools.position_errors(moved, truth), 0, atol=1e-12)
        metres, radians = tools.relative_errors(moved, truth, 10)
        np.testing.assert_allclose(metres, 0, atol=1e-12)
        np.testing.assert_allclose(radians, 0, atol=1e-12)

    def test_of_a_stretched_circle_are_those_of_the_closed_form(self):
        # A circle of radius r found as one of radius s r: alignment without scale leaves |s - 1| r at every place; over
        # an angle a the chord 2 r sin(a / 2) is found s times as long.
        count, apart, radius, stretch = 360, 30, 10.0, 1.02
        angles = 2 * np.pi * np.arange(count) / count
        truth = np.stack([tools.displaced([0, 0, angle], [radius * np.cos(angle), radius * np.sin(angle), 0])
                          for angle in angles])
        found = truth.copy()
        found[:, :3, 3] *= stretch
        np.testing.assert_allclose(tools.position_errors(found, truth), 0.02 * radius, rtol=1e-9)
        metres, radians = tools.relative_errors(found, truth, apart)
        np.testing.assert_allclose(metres, 0.02 * 2 * radius * np.sin(np.pi * apart / count), rtol=1e-9)
        np.testing.assert_allclose(radians, 0, atol=1e-7)

    def test_are_told_by_the_way_and_not_by_the_chord(self):
        # A third of a circle: r a along the arc, 2 r sin(a / 2) across.
        angles = np.linspace(0, 2 * np.pi, 361)
        truth = np.stack([tools.displaced([0, 0, angle], [10 * np.cos(angle), 10 * np.sin(angle), 0])
                          for angle in angles])
        np.testing.assert_allclose(tools.ways(truth, 120), 10 * 2 * np.pi / 3, rtol=2e-5)

    def test_a_wrong_rate_of_turn_is_found(self):
        times = np.arange(50) * 0.1
        truth = np.stack([tools.displaced([0, 0, 0.50 * time], [0, 0, 0]) for time in times])
        found = np.stack([tools.displaced([0, 0, 0.52 * time], [0, 0, 0]) for time in times])
        _, radians = tools.relative_errors(found, truth, 10)
        np.testing.assert_allclose(radians, 0.02, rtol=1e-9)

    def test_axis_and_angle_come_back_from_every_rotation(self):
        random = np.random.default_rng(2)
        for angle in (0, 1e-9, 1e-4, 1, 3.1, np.pi - 1e-9, np.pi):
            axis = random.normal(size=3)
            vector = angle * axis / np.linalg.norm(axis)
            np.testing.assert_allclose(tools.turned(tools.axis_angle(tools.turned(vector))), tools.turned(vector), atol=1e-8)


class Points(unittest.TestCase):
    def test_on_a_mesh_lie_evenly_on_its_triangles(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 3.0]])
        points, normals = tools.surface_points(corners, np.array([[0, 1, 2], [0, 1, 3]]), 20000)
        flat = points[:, 2] == 0
        self.assertAlmostEqual(flat.mean(), 0.25, delta=4.5 * np.sqrt(0.25 * 0.75 / 20000))
        np.testing.assert_allclose(points[flat].mean(axis=0), [1 / 3, 1 / 3, 0], atol=4.5 * 0.24 / np.sqrt(5000))
        np.testing.assert_allclose(np.abs(normals[flat]), np.tile([0, 0, 1], (flat.sum(), 1)))


if __name__ == "__main__":
    unittest.main()
