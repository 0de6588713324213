#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""No byte of an output depends on the C library's sines, logarithms and powers: glibc has others for processors without
FMA, which its own switch selects."""

import pathlib
import subprocess
import sys
import unittest

from cli_support import CliTest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"
WITHOUT_FMA = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable,-AVX512F_Usable"}
# Prints a digest of library functions that the switch changes where the processor has FMA.
PROBE = ("import hashlib, math; print(hashlib.sha256(repr([f(0.001 * k) for k in range(1, 1000) for f in (math.sin, math.exp,"
         " math.log, math.acos, math.atan, math.tan)]).encode()).hexdigest())")
TURNING = """models:
  - model: builtin:torus
    pose: {position: [0.3, 0.1, 0], rotation_vector: [0.2, -0.7, 0.4]}
    motion: {twist: {velocity_m_s: [3, 0, 0.5], rate_deg_s: [20, 70, -40]}}
  - {model: builtin:box, scale: 3, pose: {position: [6, 2, 0], euler_deg: {roll: 13, pitch: -7, yaw: 31}}}
"""
MOVING = "0 -4 0 0.5 0 0 0 1\n0.1 -3.8 0.1 0.5 0.1 0.1 -0.1 0.984886\n0.3 -3.5 0.2 0.6 0.2 -0.1 0.3 0.927362\n"
WEATHER = ("--visibility", "60", "--rain", "30", "--snow", "3")
SMALL = ("-w", "160", "--height", "120")


class CLibrary(CliTest):
    def setUp(self):
        super().setUp()
        probed = {subprocess.run([sys.executable, "-c", PROBE], env=self.environment | more, capture_output=True, text=True,
                                 check=True).stdout for more in ({}, WITHOUT_FMA)}
        if len(probed) == 1:
            self.skipTest("the C library's switch changes nothing here: the processor has no FMA, or this is not glibc; run it on one that has FMA")
        self.write("turning.yaml", TURNING)
        self.write("moving.tum", MOVING)

    def render(self, outputs, *arguments):
        """Outputs of the same command with both sets of functions."""
        command = ["render", *arguments, "--seed", "7", "--quiet", "--no-sidecar"]
        for name in outputs:
            command += ["-o", name]
        ordinary = self.environment
        found = []
        for more in ({}, WITHOUT_FMA):
            self.environment = ordinary | more
            self.succeed(*command)
            found.append({name: self.bytes_of(name) for name in outputs})
        self.environment = ordinary
        for name in outputs:
            self.assertTrue(found[0][name] == found[1][name], f"{name} of {' '.join(arguments)}")

    def test_changes_no_byte_of_a_preset_of_any_kind(self):
        for preset in ("VLP-16", "OS1-128", "HDL-64E-S3", "Pandar64", "RPLIDAR-A2M8", "Livox-Avia", "Livox-Mid-360", "ALTM-3100",
                       "Azure-Kinect-WFOV", "D435", "Kinect-v1", "flash-256", "woods2016-256"):
            with self.subTest(preset):
                self.render(("a.npz", "a.pcd"), "turning.yaml", "--sensor", preset, "--eye", "-4,0.3,0.2", "--columns", "all")

    def test_changes_no_byte_with_weather_and_several_returns(self):
        self.render(("a.npz", ), "turning.yaml", "--sensor", "VLP-16", "--eye", "-4,0,0.2", *WEATHER, "--returns", "strongest,last",
                    "--columns", "all")

    def test_changes_no_byte_of_depths_from_images(self):
        for preset, outputs in (("D435", ("a.ir_left.png", "a.ir_right.png")), ("Kinect-v2", ("a.ir.png", "a.tof.npy"))):
            with self.subTest(preset):
                self.render(("a.npz", *outputs), "builtin:torus", "--sensor", preset, "--depth-model", "physical")
        self.render(("a.npz", "a.patterns.npy"), "builtin:torus", "--sensor", str(EXAMPLES / "scanner.yaml"))

    def test_changes_no_byte_of_a_moving_sensor_its_imu_and_radial_velocities(self):
        moving = ("turning.yaml", "--trajectory", "moving.tum")
        self.render(("a.npz", ), *moving, "--sensor", str(EXAMPLES / "fmcw.yaml"), "--columns", "all")
        self.render(("a.mcap", "a.imu.npz"), *moving, "--sensor", "VLP-16", "--imu", "BMI088", "--duration", "0.2")
        self.render(("a.npz", ), *moving, "--sensor", "OS0-32", "--trajectory-interpolation", "spline", "--columns", "all")

    def test_changes_no_byte_of_cameras_pictures_bags_and_each_renderer(self):
        for renderer in ("rays", "raster"):
            self.render(("a.npz", "a.png", "a.depth.png", "a.ply"), "builtin:asteroid", "--renderer", renderer, *SMALL)
        self.render(("a.mcap", ), str(EXAMPLES / "drive.yaml"), "--duration", "0.1", "--deskew")


if __name__ == "__main__":
    unittest.main()
