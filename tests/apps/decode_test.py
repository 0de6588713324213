#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar decode: clouds of packet captures and bags. The built program is found in PATH."""

import json
import os
import unittest

import numpy as np
from cli_support import CliTest

ROOM = ("builtin:box:size=20,16,6", "--eye", "1,2,0", "--sensor-rate", "0,0.3,0", "--duration", "0.2", "--ground-truth")


class DecodeTest(CliTest):
    def arrays(self, name):
        with np.load(os.path.join(self.folder, name)) as stored:
            return {key: stored[key] for key in stored.files}


class Decode(DecodeTest):
    def render(self, sensor, *outputs, options=(), columns="xyz,intensity,range,ring,time"):
        words = [word for output in outputs for word in ("-o", output)]
        self.succeed("render", *ROOM, "--sensor", sensor, "--columns", columns, *options, *words)

    def compare(self, sensor, unit_m, *options, rendering=(), frames=2):
        """Decoded frames against those that were measured, beam by beam; the last packet of a frame may be decoded
        with the next."""
        self.render(sensor, "true.npz", "scan.pcap", options=rendering)
        done = self.succeed("decode", "scan.pcap", *options, "-o", "found.npz")
        self.assertIn(f"{frames} frames", done.stdout)
        self.assertIn("found_000000.npz", done.stdout)
        beams = 0
        for k in range(frames):
            true, found = self.arrays(f"true_00000{k}.npz"), self.arrays(f"found_00000{k}.npz")
            self.assertEqual(found["range"].shape, true["range"].shape)
            valid = np.isfinite(true["range"]) & np.isfinite(found["range"])
            beams += valid.sum()
            self.assertGreater(valid.mean(), 0.95)
            self.assertLessEqual(np.abs(true["range"] - found["range"])[valid].max(), 0.5001 * unit_m)
            self.assertTrue((true["ring"] == found["ring"]).all())
        self.assertGreater(beams, 10000)

    def test_velodyne_packets_are_the_measured_clouds_within_their_unit(self):
        self.compare("VLP-16", 0.002, "--sensor", "VLP-16")

    def test_ouster_packets_need_only_their_metadata(self):
        self.compare("OS1-32", 0.001)

    def test_ouster_packets_have_the_mode_of_the_sensor(self):
        self.compare("OS1-32", 0.001, rendering=("--mode", "512x20"), frames=4)
        with open(os.path.join(self.folder, "scan.json"), encoding="utf-8") as file:
            metadata = json.load(file)
        self.assertEqual(metadata["config_params"]["lidar_mode"], "512x20")
        self.assertEqual(metadata["lidar_data_format"]["columns_per_frame"], 512)
        self.compare("OS1-32", 0.001, "--sensor", "OS1-32", "--mode", "512x20", rendering=("--mode", "512x20"), frames=4)
        self.assertIn("--mode: there is no --sensor", self.refused("decode", "scan.pcap", "--mode", "512x20", "-o", "a.npz"))

    def test_hesai_packets_are_the_measured_clouds_within_their_unit(self):
        self.compare("XT32", 0.004, "--sensor", "XT32")

    def test_livox_packets_are_the_measured_clouds_within_their_unit(self):
        for data_type, unit_m in (("1", 0.001), ("2", 0.01)):
            self.compare("Livox-Avia", 1.7322 * unit_m, "--sensor", "Livox-Avia", rendering=("--livox-data-type", data_type))
            true, found = self.arrays("true_000000.npz"), self.arrays("found_000000.npz")
            self.assertTrue(np.array_equal(true["time"], found["time"]))

    def test_clouds_of_bags_have_the_points_of_the_messages(self):
        self.render("VLP-16", "true.npz", "run.mcap", "run.bag", "run.rosbag2")
        for bag in ("run.mcap", "run.bag", "run.rosbag2"):
            self.succeed("decode", bag, "--topic", "/lidar/points", "-o", "found.npz", "-o", "found.pcd")
            for k in range(2):
                true, found = self.arrays(f"true_00000{k}.npz"), self.arrays(f"found_00000{k}.npz")
                ranges = true["range"][np.isfinite(true["range"])]
                self.assertTrue(np.array_equal(np.sort(found["range"].ravel()), np.sort(ranges.ravel())))
                self.assertTrue((np.diff(found["time"].ravel().astype(np.int64)) >= 0).all())
            os.rename(os.path.join(self.folder, "found_000000.npz"), os.path.join(self.folder, "kept.npz"))

    def test_ends_after_the_given_frames(self):
        self.render("VLP-16", "scan.pcap")
        self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "--frames", "1", "-o", "one.csv")
        self.assertEqual([name for name in self.files() if name.startswith("one")], ["one_000000.csv"])

    def test_errors_state_what_is_missing(self):
        self.render("VLP-16", "scan.pcap", "run.mcap")
        self.assertIn("--sensor VLP-16, for example", self.refused("decode", "scan.pcap", "-o", "a.pcd"))
        self.assertIn("there is no -o", self.refused("decode", "scan.pcap", "--sensor", "VLP-16"))
        self.assertIn("no packet is valid", self.refused("decode", "scan.pcap", "--sensor", "VLP-32C", "-o", "a.pcd"))
        self.assertIn("manufacturer", self.refused("decode", "scan.pcap", "--sensor", "D435", "-o", "a.pcd"))
        self.assertIn("/lidar/points", self.refused("decode", "run.mcap", "--topic", "/other", "-o", "a.pcd"))
        self.assertIn("given for clouds of a bag", self.refused("decode", "run.mcap", "--columns", "xyz", "-o", "a.pcd"))
        self.assertIn("a format without", self.refused("decode", "run.mcap", "-o", "a.png"))
        self.assertIn("no such file", self.refused("decode", "missing.pcap", "-o", "a.pcd").lower())
        self.assertIn("missing.pcap", self.refused("decode", "missing.pcap", "--sensor", "VLP-16", "-o", "a.pcd"))


class Outputs(DecodeTest):
    def setUp(self):
        super().setUp()
        self.succeed("render", *ROOM, "--sensor", "VLP-16", "-o", "scan.pcap")

    def test_every_format_and_column_that_needs_no_measurement_is_written(self):
        for name in ("a.las", "a.bin", "a.csv", "a.exr", "a.bev.png", "a.view.png", "a.instance.png", "a.class.png"):
            with self.subTest(name):
                self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "--frames", "1", "-o", name)
        self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "--frames", "1", "--columns",
                     "xyz,true_xyz,true_range,instance,class,primitive", "-o", "b.npz")
        [name] = [name for name in self.files() if name.startswith("b")]
        found = self.arrays(name)
        self.assertTrue(np.isnan(found["true_range"]).all())
        for column in ("instance", "class", "primitive"):
            self.assertTrue((found[column] == 0xFFFFFFFF).all(), column)

    def test_what_packets_do_not_have_is_refused(self):
        decode = ("decode", "scan.pcap", "--sensor", "VLP-16")
        self.assertIn("a recording of all sensors", self.refused(*decode, "-o", "a.mcap"))
        self.assertIn("packets have no poses", self.refused(*decode, "-o", "a.pcd", "--frame", "world"))
        self.assertIn("packets have no poses", self.refused(*decode, "-o", "a.pcd", "--deskew"))
        self.assertIn("the frame was cast without it", self.refused(*decode, "-o", "a.pcd", "--columns", "normal"))


if __name__ == "__main__":
    unittest.main()
