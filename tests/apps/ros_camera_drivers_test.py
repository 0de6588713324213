#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""--as: bags have what the drivers of depth cameras and planar scanners publish, as an independent reader (rosbags) finds it.

The expected values were read in the sources of the drivers:
realsenseai/realsense-ros 775b167, microsoft/Azure_Kinect_ROS_Driver 6ffb95a, Slamtec/sllidar_ros2 3430009."""

import math
import unittest

from driver_support import F32, ROOM, DriverTest, layout, np, points_of, rotation, stamp_ns


class Drivers(DriverTest):
    def test_realsense_streams_and_frames(self):
        self.publish(*ROOM, "--sensor", "D435", "--as", "realsense")
        base = "/camera/camera/"
        depth = self.first(base + "depth/image_rect_raw")
        self.assertEqual((depth.encoding, depth.header.frame_id), ("16UC1", "camera_depth_optical_frame"))
        info = self.first(base + "depth/camera_info")
        self.assertEqual((info.header.frame_id, info.distortion_model, len(info.d)),
                         ("camera_depth_optical_frame", "plumb_bob", 5))
        self.assertEqual([info.p[0], info.p[2], info.p[5], info.p[6]], [info.k[0], info.k[2], info.k[4], info.k[5]])
        colour = self.first(base + "color/image_raw")
        self.assertEqual((colour.encoding, colour.header.frame_id), ("rgb8", "camera_color_optical_frame"))
        self.assertEqual(self.first(base + "color/camera_info").header.frame_id, "camera_color_optical_frame")
        aligned = self.first(base + "aligned_depth_to_color/image_raw")
        self.assertEqual(aligned.header.frame_id, "camera_color_optical_frame")
        cloud = self.first(base + "depth/color/points")
        self.assertEqual(layout(cloud), [("x", 0, F32), ("y", 4, F32), ("z", 8, F32), ("rgb", 16, F32)])
        self.assertEqual((cloud.point_step, cloud.height, cloud.is_dense), (20, 1, True))
        self.assertEqual(cloud.header.frame_id, "camera_depth_optical_frame")
        self.assertEqual(self.parents(), {
            "camera_link": "base_link", "camera_depth_frame": "camera_link",
            "camera_depth_optical_frame": "camera_depth_frame", "camera_color_frame": "camera_link",
            "camera_color_optical_frame": "camera_color_frame"})
        # x of the body is z of the optical frame, z up is -y
        optical = self.matrix("camera_depth_optical_frame")[:3, :3]
        self.assertLess(np.abs(optical - [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]).max(), 1e-9)
        pixels = np.frombuffer(bytes(depth.data), "<u2").reshape(depth.height, depth.width)
        v, u = np.nonzero(pixels)
        z = pixels[v, u] * 1e-3
        xyz = np.stack([(u - info.k[2]) / info.k[0] * z, (v - info.k[5]) / info.k[4] * z, z])
        data = points_of(cloud)[0]
        self.assertEqual(data.size, z.size)
        self.assertLess(np.abs(xyz - np.stack([data[axis] for axis in "xyz"])).max(), 0.002)

    def test_realsense_infrared_images_have_a_baseline(self):
        self.publish(*ROOM[:3], "--sensor", "D435", "--depth-model", "physical", "--as", "realsense", duration="0.03")
        base = "/camera/camera/"
        for name in ("infra1", "infra2"):
            image = self.first(f"{base}{name}/image_rect_raw")
            self.assertEqual((image.encoding, image.header.frame_id), ("mono8", f"camera_{name}_optical_frame"))
        left, right = self.first(base + "infra1/camera_info"), self.first(base + "infra2/camera_info")
        self.assertEqual(left.p[3], 0)
        self.assertAlmostEqual(-right.p[3] / right.p[0], 0.05, 3)
        self.assertEqual(right.header.frame_id, "camera_infra1_optical_frame")
        baseline = self.matrix("camera_infra2_optical_frame") - self.matrix("camera_infra1_optical_frame")
        self.assertAlmostEqual(baseline[1, 3], right.p[3] / right.p[0], 9)  # to the right: -y of the body

    def test_realsense_imu_has_optical_axes(self):
        self.publish(*ROOM, "--sensor", "D435", "--imu", "BMI088", "--as", "realsense")
        imu = self.first("/camera/camera/imu")
        self.assertEqual((imu.orientation.w, imu.orientation_covariance[0]), (0, -1))
        self.assertEqual(imu.linear_acceleration_covariance[0], 0.01)
        self.assertEqual(imu.angular_velocity_covariance[0], 0.01)
        self.assertEqual(imu.header.frame_id, "camera_imu_optical_frame")

    def test_azure_streams_and_frames(self):
        self.publish(*ROOM, "--sensor", "Azure-Kinect-NFOV", "--as", "azure")
        depth = self.first("/depth/image_raw")
        self.assertEqual((depth.encoding, depth.header.frame_id), ("16UC1", "depth_camera_link"))
        self.assertEqual(self.first("/rgb/image_raw").encoding, "bgra8")
        self.assertEqual(self.first("/rgb/image_raw").header.frame_id, "rgb_camera_link")
        self.assertEqual(self.first("/ir/image_raw").encoding, "mono16")
        for name in ("rgb", "depth", "depth_to_rgb", "rgb_to_depth", "ir"):
            self.assertIn(f"/{name}/camera_info", self.found)
        cloud = self.first("/points2")
        self.assertEqual(layout(cloud), [("x", 0, F32), ("y", 4, F32), ("z", 8, F32), ("rgb", 16, F32)])
        self.assertEqual((cloud.point_step, cloud.is_dense, cloud.header.frame_id), (32, False, "rgb_camera_link"))
        self.assertEqual((cloud.height, cloud.width), (depth.height, depth.width))
        self.assertEqual(self.parents(), {"camera_base": "base_link", "depth_camera_link": "camera_base",
                                          "rgb_camera_link": "depth_camera_link"})
        _, transform = self.transforms()["depth_camera_link"]
        self.assertAlmostEqual(transform.translation.z, 0.0018, 9)
        forward = rotation(transform.rotation)[:, 2]  # the optical axis, 6 degrees down
        self.assertLess(np.abs(forward - [math.cos(math.radians(6)), 0, -math.sin(math.radians(6))]).max(), 1e-9)

    def test_rplidar_scan_has_bins_and_a_positive_time_increment(self):
        self.publish("builtin:box:size=6,4,2", "--eye", "1,0,0", "--ground-truth", "--sensor", "RPLIDAR-A2M8", "--as", "rplidar")
        record_ns, scan = self.found["/scan"][0]
        self.assertEqual(scan.header.frame_id, "laser")
        self.assertNotIn("/lidar/points", self.found)
        count = 360 * 3  # 800 points of a turn: 2 in a degree, and one more
        self.assertEqual(len(scan.ranges), count)
        self.assertAlmostEqual(scan.angle_min, -math.pi, 6)
        self.assertAlmostEqual(scan.angle_max, math.pi, 6)
        self.assertAlmostEqual(scan.angle_increment, 2 * math.pi / (count - 1), 8)
        self.assertAlmostEqual(scan.time_increment, scan.scan_time / (count - 1), 8)
        self.assertAlmostEqual(scan.range_min, 0.05, 6)
        self.assertEqual(scan.range_max, 12)
        self.assertEqual(stamp_ns(scan), self.found["/clock"][0][0])  # the start of the turn
        self.assertEqual(record_ns, stamp_ns(scan) + 10**8)
        # zero of the device is at the ends of the array: the wall 2 m ahead; 4 m behind; 2 m to both sides
        self.assertAlmostEqual(scan.ranges[0], 2, 2)
        self.assertAlmostEqual(scan.ranges[-1], 2, 2)
        self.assertAlmostEqual(scan.ranges[count // 2], 4, 2)
        self.assertLess(np.abs(self.matrix("laser")[:3, :3] - np.diag([-1, -1, 1])).max(), 1e-9)


if __name__ == "__main__":
    unittest.main()
