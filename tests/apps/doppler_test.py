#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Radial velocities in the program. The built program is found in PATH."""

import unittest

from cli_support import CliTest

SCENE = """models:
  - model: 'builtin:box:size=1,40,40'
    pose: {position: [20, 0, 0]}
    motion: {twist: {velocity_m_s: [3, 0, 0]}}
sensors:
  - {name: fmcw, sensor: fmcw.yaml}
  - {name: plain, sensor: {optics: {type: line_scan, azimuth_deg: [-5, 0, 5]}}}
rig_pose: {position: [0, 0, 0]}
rig_motion: {twist: {velocity_m_s: [10, 0, 0]}}
"""
FMCW = """optics: {type: line_scan, azimuth_deg: [-5, 0, 5], point_us: 100}
doppler: {sigma_m_s: 0.1}
noise: [{type: range_gaussian, sigma_m: 0.02}]
"""


class Doppler(CliTest):
    def setUp(self):
        super().setUp()
        self.write("scene.yaml", SCENE)
        self.write("fmcw.yaml", FMCW)

    def rows(self, name):
        head, *lines = self.bytes_of(name).decode().splitlines()
        return [dict(zip(head.split(","), line.split(","))) for line in lines]

    def test_columns_of_a_sensor_that_measures_none_are_refused_by_name(self):
        arguments = ("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "-o", "a.csv", "--columns")
        error = self.refused(*arguments, "xyz,radial_velocity")
        self.assertIn("cloud column 'radial_velocity': the sensor 'Velodyne VLP-16' does not measure it", error)
        self.assertIn("add 'doppler: {}' to a sensor file", error)
        self.assertNotIn("a.csv", self.files())
        self.succeed(*arguments, "true_radial_velocity")
        self.assertEqual({row["true_radial_velocity"] for row in self.rows("a.csv")} - {"nan", "NaN"}, {"0"})
        error = self.refused("render", "builtin:box", "--colour-by", "radial_velocity", "-o", "a.bev.png")
        self.assertIn("radial_velocity: the sensor does not measure it", error)

    def test_a_rig_writes_them_beside_sensors_that_measure_none(self):
        self.succeed("render", "scene.yaml", "--columns", "radial_velocity,true_radial_velocity", "-o", "a.csv")
        for row in self.rows("a_fmcw.csv"):
            self.assertAlmostEqual(float(row["true_radial_velocity"]), -7.0, delta=0.03)  # cosine of 5 degrees
            self.assertAlmostEqual(float(row["radial_velocity"]), -7.0, delta=0.6)
        for row in self.rows("a_plain.csv"):
            self.assertIn(row["radial_velocity"].lower(), ("nan", ""))

    def test_explain_prints_how_the_reported_velocity_arose(self):
        self.succeed("render", "scene.yaml", "--sensor-name", "fmcw", "--columns", "radial_velocity", "-o", "a.csv")
        reported = float(self.rows("a.csv")[1]["radial_velocity"])
        text = self.succeed("explain", "a.csv", "--index", "1").stdout
        self.assertIn("radial velocity -7 m/s, positive away from the sensor", text)
        self.assertRegex(text, r"doppler   -7\.000000 m/s received, sigma 0\.1 m/s, standard normal -?\d")
        self.assertRegex(text, rf"reported  .*, {reported:+.6f} m/s")

    def test_a_replay_measures_the_same_velocities(self):
        self.succeed("stream", "scene.yaml", "--frames", "3", "--rate", "max", "--record", "r.jsonl",
                     "--columns", "xyz,radial_velocity", "-o", "first.csv", "--no-sidecar")
        self.succeed("replay", "r.jsonl", "-o", "again.csv", "--columns", "xyz,radial_velocity", "--no-sidecar")
        first = [name for name in self.files() if name.startswith("first")]
        self.assertEqual(len(first), 6)
        for name in first:
            self.assertEqual(self.bytes_of(name), self.bytes_of(name.replace("first", "again")))


if __name__ == "__main__":
    unittest.main()
