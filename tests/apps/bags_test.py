#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Bags of glidar render, read by rosbags. The built program is found in PATH."""

import io
import json
import struct
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np
from cli_support import CliTest
from skipping import importing

with importing():
    from PIL import Image
    from rosbags.highlevel import AnyReader

ROOM = ("builtin:box:size=20,16,6", "--eye", "1,2,0", "--sensor-rate", "0,0.3,0", "--duration", "0.2", "--ground-truth")

RIG = """models: [{model: "builtin:box:size=20,16,6"}]
sensors:
  - {name: front, sensor: VLS-128, pose: {position: [1, 0, 0]}}
  - {name: rear, sensor: VLP-16, pose: {position: [-1, 0, 0]}}
  - {name: camera, sensor: D435, pose: {position: [0, 0, 1]}}
imus:
  - {name: imu, imu: BMI088}
  - {name: second, imu: {rate_hz: 130}}
rig_pose: {position: [0, 0, 0]}
rig_motion: {twist: {velocity_m_s: [0.5, 0, 0], rate_deg_s: [0, 0, 20]}}
"""


class Bags(CliTest):
    def messages(self, name):
        """Topic, time and message of all messages in the order of the file."""
        with AnyReader([self.path(name)]) as reader:
            return [(connection.topic, time_ns, reader.deserialize(raw, connection.msgtype))
                    for connection, time_ns, raw in reader.messages()]

    def path(self, name):
        return Path(self.folder, name)

    def of(self, name, topic):
        return [message for found, _, message in self.messages(name) if found == topic]

    def test_messages_of_a_rig_are_sorted_by_time_across_topics(self):
        """In the order of the file, which readers of MCAP do not change within chunks that do not overlap."""
        from mcap.stream_reader import StreamReader

        self.write("scene.yaml", RIG)
        self.succeed("render", "scene.yaml", "--duration", "0.2", "--packet-topics", "-o", "run.mcap")
        with open(self.path("run.mcap"), "rb") as file:
            times = [record.log_time for record in StreamReader(file).records if type(record).__name__ == "Message"]
        self.assertGreater(len(times), 150)
        self.assertEqual(times, sorted(times))
        stamps = {}
        for topic, time_ns, message in self.messages("run.mcap"):
            if not hasattr(message, "header"):
                continue
            stamp_ns = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
            # scans are received when they are complete
            is_scan = topic.startswith(("/front", "/rear")) and not topic.endswith("packets")
            self.assertGreaterEqual(time_ns, stamp_ns + (90_000_000 if is_scan else 0), topic)
            self.assertLessEqual(time_ns, stamp_ns + (100_100_000 if is_scan else 0), topic)
            stamps.setdefault(topic, []).append(stamp_ns)
        self.assertIn("/second/data", stamps)
        for topic, times in stamps.items():
            self.assertEqual(times, sorted(set(times)), topic)

    def test_compressed_images_have_the_pixels_of_raw_images(self):
        self.succeed("render", *ROOM, "--sensor", "D435", "--image-transport", "both", "-o", "run.mcap")
        raw = self.of("run.mcap", "/camera/depth/image_raw")
        packed = self.of("run.mcap", "/camera/depth/image_raw/compressedDepth")
        self.assertEqual(len(raw), len(packed))
        self.assertGreaterEqual(len(raw), 2)
        for image, compressed in zip(raw, packed, strict=True):
            self.assertEqual(compressed.header.stamp.sec, image.header.stamp.sec)
            self.assertEqual(compressed.header.stamp.nanosec, image.header.stamp.nanosec)
            self.assertEqual(compressed.header.frame_id, image.header.frame_id)
            self.assertEqual(compressed.format, "16UC1; compressedDepth png")
            self.assertEqual(struct.unpack("<iff", bytes(compressed.data[:12])), (0, 0.0, 0.0))
            found = np.asarray(Image.open(io.BytesIO(bytes(compressed.data[12:]))), dtype=float)
            depth = np.frombuffer(image.data, dtype="<f4").reshape(image.height, image.width)
            self.assertEqual(found.shape, depth.shape)
            self.assertTrue((np.isfinite(depth) == (found > 0)).all())
            self.assertLessEqual(np.nanmax(np.abs(found / 1e3 - depth)[found > 0]), 0.000501)
        grey = self.of("run.mcap", "/camera/intensity/image_raw/compressed")
        self.assertEqual(grey[0].format, "mono8; png compressed ")
        self.assertEqual(Image.open(io.BytesIO(bytes(grey[0].data))).size, (raw[0].width, raw[0].height))

    def test_images_of_a_camera_have_names_encodings_and_camera_infos(self):
        self.succeed("render", *ROOM, "--sensor", "D435", "--depth-image", "16UC1", "-o", "run.mcap")
        infos = [m for name in ("depth", "intensity", "color") for m in self.of("run.mcap", f"/camera/{name}/camera_info")]
        self.assertEqual({info.header.frame_id for info in infos}, {"camera_depth_optical_frame"})
        depth = self.of("run.mcap", "/camera/depth/image_raw")[0]
        self.assertEqual(depth.encoding, "16UC1")
        self.assertEqual(self.of("run.mcap", "/camera/intensity/image_raw")[0].encoding, "mono8")
        self.assertEqual(self.of("run.mcap", "/camera/color/image_raw")[0].encoding, "rgb8")
        pixels = np.frombuffer(bytes(depth.data), dtype="<u2").reshape(depth.height, depth.width)
        cloud = self.of("run.mcap", "/camera/points")[0]
        data = np.frombuffer(bytes(cloud.data), dtype=np.uint8).reshape(-1, cloud.point_step)
        z = data[:, 8:12].copy().view("<f4")[:, 0]
        self.assertEqual((pixels > 0).sum(), z.size)
        self.assertLessEqual(np.abs(np.sort(pixels[pixels > 0]) * 1e-3 - np.sort(z)).max(), 0.000501)

    def test_a_bag_is_a_trajectory_whatever_its_frames(self):
        self.write("scene.yaml", RIG)
        for mode in ("ground_truth", "map"):
            self.succeed("render", "scene.yaml", "--duration", "0.2", "--tf", mode, "--sensor-name", "rear", "-o", "run.mcap")
            self.succeed("render", "builtin:box:size=20,16,6", "--sensor", "VLP-16", "--trajectory", "run.mcap",
                         "--tf", "map", "--duration", "0.1", "-o", "again.mcap")
            first, again = (self.of(name, topic)[5].pose.pose for name, topic in (
                ("run.mcap", "/ground_truth/odom" if mode == "ground_truth" else "/odom"), ("again.mcap", "/odom")))
            for axis in "xyz":
                self.assertAlmostEqual(getattr(first.position, axis), getattr(again.position, axis), 9)
                self.assertAlmostEqual(getattr(first.orientation, axis), getattr(again.orientation, axis), 9)

    def test_compressed_images_replace_raw_ones(self):
        self.succeed("render", *ROOM, "--sensor", "D435", "--image-transport", "compressed", "-o", "run.rosbag2")
        topics = {topic for topic, _, _ in self.messages("run.rosbag2")}
        self.assertIn("/camera/depth/image_raw/compressedDepth", topics)
        self.assertIn("/camera/depth/camera_info", topics)
        self.assertNotIn("/camera/depth/image_raw", topics)

    def test_bags_of_ros_1_are_converted_and_read(self):
        error = self.refused("render", *ROOM, "--sensor", "VLP-16", "-o", "run.bag")
        self.assertIn("`rosbags-convert --src run.rosbag2 --dst run.bag`", error)
        self.succeed("render", *ROOM, "--sensor", "VLP-16", "-o", "run.rosbag2")
        subprocess.run([sys.executable, "-m", "rosbags.convert", "--src", "run.rosbag2", "--dst", "run.bag"], cwd=self.folder,
                       check=True)
        for name in ("run.bag", "run.rosbag2"):
            self.succeed("decode", name, "--topic", "/lidar/points", "-o", name + ".npz")
        for k in range(2):
            with np.load(self.path(f"run.bag_00000{k}.npz")) as a, np.load(self.path(f"run.rosbag2_00000{k}.npz")) as b:
                self.assertEqual(set(a.files), set(b.files))
                for column in a.files:
                    self.assertTrue(np.array_equal(a[column], b[column], equal_nan=True), column)
        self.succeed("render", "builtin:box", "--sensor", "VLP-16", "--trajectory", "run.bag", "--duration", "0.1", "-o", "a.npz")

    def test_ouster_packets_are_those_of_a_capture(self):
        self.succeed("render", *ROOM, "--sensor", "OS1-32", "--packet-topics", "-o", "run.mcap", "-o", "scan.pcap",
                     "-o", "true.npz")
        metadata = self.of("run.mcap", "/ouster/metadata")
        self.assertEqual(json.loads(metadata[0].data), json.loads(self.path("scan.json").read_text()))
        stored = [bytes(message.buf) for message in self.of("run.mcap", "/ouster/lidar_packets")]
        self.assertGreater(len(stored), 100)
        capture = self.path("scan.pcap").read_bytes()
        fragment = 1400  # bytes of a packet that is larger than an Ethernet frame
        self.assertEqual([capture.find(packet[:fragment]) > 0 for packet in stored], [True] * len(stored))
        self.succeed("decode", "run.mcap", "--topic", "/ouster/lidar_packets", "-o", "a.npz")
        self.succeed("decode", "scan.pcap", "-o", "b.npz")
        for k in range(2):
            with np.load(self.path(f"a_00000{k}.npz")) as a, np.load(self.path(f"b_00000{k}.npz")) as b:
                self.assertTrue(np.array_equal(a["range"], b["range"], equal_nan=True))
                self.assertTrue(np.isfinite(a["range"]).any())

    def test_velodyne_packets_are_a_scan_per_revolution(self):
        self.succeed("render", *ROOM, "--sensor", "VLP-16", "--packet-topics", "-o", "run.rosbag2", "-o", "scan.pcap")
        scans = self.of("run.rosbag2", "/velodyne_packets")
        self.assertIn(len(scans), (2, 3))  # the last packet is filled after the last frame
        packets = [packet for scan in scans for packet in scan.packets]
        capture = self.path("scan.pcap").read_bytes()
        for packet in packets:
            self.assertIn(bytes(packet.data), capture)
        for scan in scans:
            self.assertEqual(scan.header.stamp, scan.packets[-1].stamp)
        self.succeed("decode", "run.rosbag2", "--topic", "/velodyne_packets", "--sensor", "VLP-16", "-o", "a.npz")
        self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "-o", "b.npz")
        with np.load(self.path("a_000000.npz")) as a, np.load(self.path("b_000000.npz")) as b:
            self.assertTrue(np.array_equal(a["range"], b["range"], equal_nan=True))

    def test_packets_need_a_sensor_that_has_them(self):
        self.assertIn("--packet-topics",
                      self.refused("render", *ROOM, "--sensor", "D435", "--packet-topics", "-o", "run.mcap"))


if __name__ == "__main__":
    unittest.main()
