#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream between publishers and readers of ROS 2."""

import json
import os
import struct
import subprocess
import time
import unittest

from dds_support import DdsTest, bag_messages, same_message, skip_without, wait_for_line, wait_until

skip_without("GLIDAR_DDS_PEER")

CLOUD = "sensor_msgs/msg/PointCloud2"
ODOMETRY = "nav_msgs/msg/Odometry"


class Cdr:
    """Writes CDR, little-endian: numbers are aligned to their size behind the header."""

    def __init__(self):
        self.bytes = bytearray()

    def number(self, code, *values):
        size = struct.calcsize(code)
        for value in values:
            self.bytes += bytes(-len(self.bytes) % size) + struct.pack("<" + code, value)
        return self

    def text(self, value):
        self.number("I", len(value) + 1)
        self.bytes += value.encode() + b"\0"
        return self

    def header(self, sec, frame):
        return self.number("i", sec).number("I", 0).text(frame)

    def hex(self):
        return (b"\0\1\0\0" + self.bytes).hex()


def odometry(sec, x):
    message = Cdr().header(sec, "odom").text("base_link").number("d", x, 0.0, 1.5, 0.0, 0.0, 0.0, 1.0)
    return message.number("d", *[0.0] * 36, *[0.0] * 6, *[0.0] * 36).hex()


class Stream(DdsTest):
    def stream(self, *arguments):
        return self.start("glidar", "stream", "builtin:box:size=2,2,2", "--sensor", "VLP-16", "--eye", "5,0,0",
                          *arguments)

    def test_publishes_the_messages_of_bags(self):
        reader = self.peer("read", "/robot/lidar/points", CLOUD, 3)
        wait_for_line(reader.stdout, "ready")
        program = self.stream("--ros2", "--namespace", "robot", "-o", "run.rosbag2")
        clouds = [bytes.fromhex(line) for line in self.finish(reader).split()]
        program.terminate()
        program.wait()
        stored = bag_messages(self.folder / "run.rosbag2")["/lidar/points"]
        self.assertEqual(len(clouds), 3)
        for cloud in clouds:
            self.assertTrue(any(same_message(cloud, message) for message in stored))

    def test_the_clock_advances_between_frames(self):
        clock = self.peer("read", "/clock", "rosgraph_msgs/msg/Clock", 30)
        clouds = self.peer("read", "/camera/points", CLOUD, 2)
        for reader in (clock, clouds):
            wait_for_line(reader.stdout, "ready")
        self.start("glidar", "stream", "builtin:box", "--rate", "0.2", "--ros2")
        self.finish(clock)  # 0.3 s of 5 s until the second frame
        before = time.monotonic()
        self.finish(clouds)
        self.assertGreater(time.monotonic() - before, 1.0)

    def test_late_readers_get_static_transforms(self):
        self.stream("--ros2")
        reader = self.peer("read", "/tf_static", "tf2_msgs/msg/TFMessage", 1)
        wait_for_line(reader.stdout, "ready")
        message = bytes.fromhex(self.finish(reader))
        self.assertIn(b"base_link\0", message)

    def test_measures_at_poses_of_odometry(self):
        program = self.stream("--pose-source", "ros2:/odom", "--rate", "max", "--pose-queue", "10", "--frames", "3",
                              "--record", "poses.jsonl")
        writer = self.peer("write", "/odom", ODOMETRY)
        wait_for_line(writer.stdout, "matched")
        for sec in (7, 8, 9):
            self.order(writer, odometry(sec, 0.5 * sec))
        self.assertEqual(program.wait(), 0)
        frames = [json.loads(line) for line in (self.folder / "poses.jsonl").read_text().splitlines()]
        text = json.dumps(frames)
        for expected in ("7000000000", "8000000000", "9000000000", "4.5"):
            self.assertIn(expected, text)

    def test_leaves_out_poses_that_are_out_of_reach(self):
        scene = {"models": [{"name": "box", "model": "builtin:box"}], "sensors": [
            {"name": name, "sensor": "VLP-16", "pose": {"position": [5, 0, 0]}} for name in ("front", "rear")]}
        (self.folder / "scene.yaml").write_text(json.dumps(scene))
        program = self.start("glidar", "stream", "scene.yaml", "--pose-source", "ros2:/odom", "--rate", "max",
                             "--pose-queue", "10", "--frames", "3", "--record", "poses.jsonl")
        writer = self.peer("write", "/odom", ODOMETRY)
        wait_for_line(writer.stdout, "matched")
        for sec, x in ((7, 0.0), (8, 1e15), (9, 1.0)):
            self.order(writer, odometry(sec, x))
        self.assertEqual(program.wait(), 0)
        text = (self.folder / "poses.jsonl").read_text()
        self.assertIn("9000000000", text)
        self.assertNotIn("8000000000", text)

    def test_replays_what_ros_gave(self):
        program = self.stream("--pose-source", "ros2:/odom", "--rate", "max", "--pose-queue", "10", "--frames", "2",
                              "--record", "poses.jsonl", "-o", "a.csv")
        writer = self.peer("write", "/odom", ODOMETRY)
        wait_for_line(writer.stdout, "matched")
        for sec in (7, 8):
            self.order(writer, odometry(sec, 0.1 * sec))
        self.assertEqual(program.wait(), 0)
        replay = self.start("glidar", "replay", "poses.jsonl", "-o", "b.csv")
        self.assertEqual(replay.wait(), 0)
        clouds = sorted(self.folder.glob("a*.csv"))
        self.assertEqual(len(clouds), 2)
        for cloud in clouds:
            self.assertEqual(cloud.read_bytes(), (self.folder / cloud.name.replace("a", "b", 1)).read_bytes())

    def test_follows_the_clock(self):
        program = self.stream("--pose-source", "ros2:/clock", "--frames", "2", "--record", "times.jsonl")
        writer = self.peer("write", "/clock", "rosgraph_msgs/msg/Clock")
        wait_for_line(writer.stdout, "matched")
        now = [100]

        def advance():
            self.order(writer, Cdr().number("i", now[0]).number("I", 0).hex())
            now[0] += 1
            return program.poll() is not None
        wait_until(advance, "two frames")
        self.assertEqual(program.returncode, 0)
        self.assertRegex((self.folder / "times.jsonl").read_text(), r"\b1[0-9]{11}\b")

    def test_the_pose_source_owns_transforms_and_the_clock(self):
        program = self.stream("--pose-source", "ros2:/odom", "--rate", "max", "--ros2")
        reader = self.peer("read", "/lidar/points", CLOUD, 1)
        wait_for_line(reader.stdout, "ready")
        writer = self.peer("write", "/odom", ODOMETRY)
        wait_for_line(writer.stdout, "matched")
        self.order(writer, odometry(7, 0.0))
        sec = [8]

        def advance():
            self.order(writer, odometry(sec[0], 0.0))
            sec[0] += 1
            return reader.poll() is not None
        wait_until(advance, "a cloud")
        cloud = bytes.fromhex(self.finish(reader))
        self.assertGreaterEqual(struct.unpack_from("<i", cloud, 4)[0], 7)
        self.assertIsNone(program.poll())

    def test_ends_without_poses(self):
        program = self.stream("--pose-source", "ros2:/odom", "--pose-timeout", "0.1", "--ros2")
        self.assertEqual(program.wait(), 3)

    def refused(self, *arguments, **variables):
        done = subprocess.run(["glidar", "stream", "builtin:box", *arguments], capture_output=True, text=True,
                              cwd=self.folder, env=os.environ | variables, check=False)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def test_refuses_invalid_settings(self):
        self.assertIn("0 to 232", self.refused("--ros2", ROS_DOMAIN_ID="233"))
        self.assertIn("lo", self.refused("--ros2", "--ros2-interface", "nosuch0"))
        self.assertIn("--namespace", self.refused("--ros2", "--namespace", "my robot"))
        self.assertIn("--pose-source", self.refused("--ros2", "--pose-source", "ros2:/tf:map"))
        self.assertIn("--ros2", self.refused("--namespace", "robot", "--port", "5555"))


if __name__ == "__main__":
    unittest.main()
