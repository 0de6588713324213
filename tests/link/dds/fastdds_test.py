#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Fast DDS, another implementation of DDS, reads the topics: the messages are those of the bag writer."""

import os
import unittest

from dds_support import DdsTest, bag_messages, same_message, skip_without, wait_for_line

skip_without("GLIDAR_DDS_PEER", "GLIDAR_FASTDDS_READER")

TYPES = {"PointCloud2": "sensor_msgs", "Image": "sensor_msgs", "CompressedImage": "sensor_msgs",
         "CameraInfo": "sensor_msgs", "LaserScan": "sensor_msgs", "Imu": "sensor_msgs", "TFMessage": "tf2_msgs",
         "Odometry": "nav_msgs", "Clock": "rosgraph_msgs", "PoseStamped": "geometry_msgs"}


class FastDds(DdsTest):
    def test_messages_of_every_type_arrive_byte_for_byte(self):
        writer = self.peer("samples", "all.rosbag2")
        wait_for_line(writer.stdout, "ready")
        expected = bag_messages(self.folder / "all.rosbag2")
        for name, package in TYPES.items():
            with self.subTest(name):
                reader = self.start(os.environ["GLIDAR_FASTDDS_READER"], f"rt/{name}", f"{package}::msg::dds_::{name}_", 3)
                self.write_until(writer, lambda: reader.poll() is not None)
                messages = [bytes.fromhex(line) for line in self.finish(reader).split() if line != "matched"]
                self.assertEqual(len(messages), 3)
                for message in messages:
                    self.assertTrue(any(same_message(message, sample) for sample in expected[f"/{name}"]), message.hex())
        self.assertIsNone(writer.poll())


if __name__ == "__main__":
    unittest.main()
