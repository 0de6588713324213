#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/odometry_bags.py, shortened: KISS-ICP reads our bags, and drifts more without the times of points."""

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
    import rosbags  # noqa: F401
    import glidar  # noqa: F401

import odometry_bags as study
from odometry_pictures import draw_runs

SECONDS = 4.0
# A second's way is 9 m, and the motion during a revolution 10 % of it; see docs/studies.md.
MAX_DRIFT_PERCENT = 4.0


class OdometryOfBags(unittest.TestCase):
    def test_drift_is_small_and_larger_without_times(self):
        for suffix in (".rosbag2", ".mcap"):
            with self.subTest(suffix), tempfile.TemporaryDirectory() as folder:
                with_times, without = study.run(
                    study.flags_of(["--seconds", str(SECONDS), "--format", suffix]), folder)
                self.assertEqual(len(with_times.poses), SECONDS * 10)
                self.assertLess(with_times.drift_percent, MAX_DRIFT_PERCENT)
                self.assertGreater(without.drift_percent, 1.1 * with_times.drift_percent)
                self.assertGreater(without.turn_deg_m, with_times.turn_deg_m)
                picture = Path(folder, "odometry.png")
                draw_runs([with_times, without], picture)
                self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))


if __name__ == "__main__":
    unittest.main()
