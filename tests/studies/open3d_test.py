#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Depths of Open3D's RaycastingScene, through bench/open3d_bench.py: another program casts the same rays."""

import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
sys.path.insert(0, str(ROOT / "tests/support"))
from skipping import importing

with importing():
    import open3d  # noqa: F401
    import glidar  # noqa: F401

import numpy as np
import open3d_bench as bench


class Depths(unittest.TestCase):
    def test_are_those_of_open3d_within_single_precision(self):
        for model in ("builtin:asteroid", "builtin:torus", str(ROOT / "models" / "satellite" / "satellite.obj")):
            with self.subTest(model):
                views = bench.Views(model, 160, 120)
                differences, lonely, hits = views.compare()
                self.assertGreater(hits, 2000)
                # Open3D's rays and depths are single precision: a few steps of 2^-23 of the camera's distance on
                # surfaces that face it; where they graze, the same error sideways becomes one along the beam.
                distance_m = np.linalg.norm(views.pose[:3, 3])
                self.assertLess(np.median(differences), 4 * 2.0**-23 * distance_m)
                self.assertLess(np.percentile(differences, 99), 100 * 2.0**-23 * distance_m)
                self.assertLess(lonely, 4)  # borders, where rounding decides


if __name__ == "__main__":
    unittest.main()
