# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""IMUs on the command line. The built program is found in PATH."""

import csv
import json
import os
import unittest

import numpy as np
from cli_support import CliTest

SCENE = """models: [{model: builtin:box, pose: {position: [3, 0, 0]}}]
sensors: [{name: lidar, sensor: VLP-16}]
imus:
  - {name: front, imu: BMI088, pose: {position: [0.5, 0, 0]}}
  - {name: ideal, imu: {rate_hz: 100}, pose: {position: [0.5, 0, 0]}}
rig_pose: {position: [0, 0, 1]}
rig_motion: {spin: {rate_rad_s: [0, 0, 2]}}
"""
BOX = ("render", "builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0")


class Imus(CliTest):
    def rows(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_a_rig_writes_every_imu_beside_the_clouds(self):
        self.write("scene.yaml", SCENE)
        text = self.succeed("render", "scene.yaml", "--duration", "0.2", "-o", "run.pcd", "-o", "run.imu.csv").stdout
        self.assertIn("wrote run_front.imu.csv", text)
        self.assertTrue(os.path.exists(os.path.join(self.folder, "run.pcd")) or
                        os.path.exists(os.path.join(self.folder, "run_lidar.pcd")))
        rows = self.rows("run_ideal.imu.csv")
        self.assertEqual([row["t_ns"] for row in rows], [k * 1e7 for k in range(21)])  # to the end of frame 1
        for row in rows:
            self.assertAlmostEqual(row["accel_x"], -2.0, 12)
            self.assertAlmostEqual(row["accel_z"], 9.80665, 12)
            self.assertAlmostEqual(row["gyro_z"], 2.0, 12)
        self.assertEqual(len(self.rows("run_front.imu.csv")), 41)
        with open(os.path.join(self.folder, "run_front.imu.csv.json"), encoding="utf-8") as file:
            described = json.load(file)
        self.assertEqual(described["name"], "front")
        self.assertEqual(described["imu"]["rate_hz"], 200)

    def test_npz_has_the_numbers_of_csv(self):
        options = ("--imu", "ICM-20948", "--duration", "0.1", "--seed", "7")
        self.succeed(*BOX, *options, "-o", "a.imu.csv", "-o", "a.imu.npz")
        rows = self.rows("a.imu.csv")
        with np.load(os.path.join(self.folder, "a.imu.npz")) as arrays:
            for name in ("gyro", "accel", "true_gyro", "true_accel", "gyro_bias", "accel_bias", "velocity"):
                expected = [[row[f"{name}_{axis}"] for axis in "xyz"] for row in rows]
                self.assertTrue(np.array_equal(arrays[name], expected), name)
            self.assertEqual(arrays["t_ns"].tolist(), [row["t_ns"] for row in rows])
            self.assertEqual(arrays["world_from_imu"].shape, (len(rows), 4, 4))

    def test_the_samples_depend_on_the_seed_alone(self):
        options = (*BOX, "--imu", "BMI088", "--duration", "0.1", "--quiet", "--seed")
        for name, seed, threads in [("a", "7", "1"), ("b", "7", "3"), ("c", "8", "1")]:
            self.succeed(*options, seed, "--threads", threads, "-o", f"{name}.imu.csv")
        a, b, c = (open(os.path.join(self.folder, f"{n}.imu.csv"), "rb").read() for n in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)

    def test_linearly_interpolated_poses_are_reported(self):
        self.write("walk.tum", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.3 1 2 0 0 0 0 1\n")
        options = ("render", "builtin:box", "--sensor", "VLP-16", "--imu", "BMI088", "--trajectory", "walk.tum",
                   "--duration", "0.1", "-o", "a.imu.csv")
        self.assertIn("interpolation", self.succeed(*options).stderr)
        smooth = self.succeed(*options, "--trajectory-interpolation", "spline")
        self.assertNotIn("velocities jump", smooth.stderr)

    def test_streams_and_replays_write_the_same_samples(self):
        self.write("scene.yaml", SCENE)
        self.succeed("render", "scene.yaml", "--duration", "0.2", "-o", "a.imu.csv")
        self.succeed("stream", "scene.yaml", "--duration", "0.2", "--rate", "max", "-o", "b.imu.csv", "--record", "r.jsonl")
        self.succeed("replay", "r.jsonl", "-o", "c.imu.csv")
        for imu in ("front", "ideal"):
            samples = self.bytes_of(f"a_{imu}.imu.csv")
            self.assertEqual(self.bytes_of(f"b_{imu}.imu.csv"), samples)
            self.assertEqual(self.bytes_of(f"c_{imu}.imu.csv"), samples)
        self.assertIn("there is no IMU", self.refused("stream", *BOX[1:], "--frames", "1", "-o", "a.imu.csv"))

    def test_errors_state_what_is_missing(self):
        self.assertIn("--duration", self.refused(*BOX, "--imu", "BMI088", "-o", "a.imu.csv"))
        self.assertIn("there is no IMU", self.refused(*BOX, "--duration", "0.1", "-o", "a.imu.csv"))
        self.assertIn("did you mean BMI088?", self.refused(*BOX, "--imu", "BMI08", "--duration", "0.1", "-o", "a.imu.csv"))
        self.write("scene.yaml", SCENE)
        self.assertIn("has IMUs", self.refused("render", "scene.yaml", "--imu", "BMI088", "-o", "a.pcd"))

    def test_an_imu_whose_samples_no_output_has_is_refused(self):
        imu = ("--imu", "BMI088")
        for outputs in (["-o", "a.pcd"], ["-o", "a.osi"], ["-o", "a.kitti"], ["-o", "a.pcap"]):
            error = self.refused(*BOX, *imu, *outputs)
            self.assertIn("--imu: no output has samples of an IMU; allowed: the suffixes .imu.csv", error)
            self.assertIn("or leave --imu out", error)
        self.assertIn("--imu: no output", self.refused("stream", *BOX[1:], *imu, "--frames", "1", "-o", "a.pcd"))
        self.assertIn("--imu", self.refused("stream", *BOX[1:], *imu, "--lockstep", "ipc://x.socket"))
        self.succeed(*BOX, *imu, "-o", "a.mcap")
        self.succeed("render", "builtin:box", "--sensor", "OS1-32", "--eye", "0,0,0", *imu, "-o", "a.pcap")

    def test_a_replay_of_a_run_with_an_imu_may_have_other_outputs(self):
        self.succeed("stream", *BOX[1:], "--imu", "BMI088", "--frames", "1", "--rate", "max", "--record", "r.jsonl")
        self.succeed("replay", "r.jsonl", "-o", "b.pcd")
        self.succeed("replay", "r.jsonl", "-o", "b.imu.csv")

    def test_presets_are_listed_with_their_sources(self):
        names = [line.split()[0] for line in self.succeed("sensors", "--imus").stdout.splitlines()[2:]]
        self.assertEqual(names, ["ADIS16448", "BMI088", "ICM-20948"])
        listed = json.loads(self.succeed("sensors", "--imus", "--json").stdout)
        self.assertEqual([entry["name"] for entry in listed], names)
        self.assertIn("DS-000189", self.succeed("sensors", "icm-20948").stdout)
        self.assertIn("alone", self.refused("sensors", "BMI088", "--imus"))


if __name__ == "__main__":
    unittest.main()
