#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""--as: bags have what the drivers of LiDARs publish, field by field, as an independent reader (rosbags) finds it.

The expected values were read in the sources of the drivers:
ros-drivers/velodyne 04a7ca7, ouster-lidar/ouster-ros f5c4ef8, ouster-lidar/ouster-sdk 46b7bce, Livox-SDK/livox_ros_driver2 13eb05e,
HesaiTechnology/HesaiLidar_ROS_2.0 e7e112f, RoboSense-LiDAR/rslidar_sdk 78d2abb."""

import math
import unittest
from pathlib import Path

from driver_support import F32, F64, OPEN, ROOM, U8, U16, U32, XYZI, DriverTest, layout, np, points_of, stamp_ns, stamp_s, wrapped


class Drivers(DriverTest):
    def test_velodyne_points_are_organised_with_times_before_the_stamp(self):
        self.publish(*OPEN, "--sensor", "VLP-16", "--as", "velodyne", duration="0.2")
        self.assertTrue({"/velodyne_points", "/velodyne_packets", "/scan"} <= set(self.found))
        self.assertNotIn("/lidar/points", self.found)
        record_ns, cloud = self.found["/velodyne_points"][0]
        self.assertEqual(cloud.header.frame_id, "velodyne")
        self.assertEqual(layout(cloud), [*XYZI, ("ring", 16, U16), ("time", 18, F32)])
        self.assertEqual((cloud.point_step, cloud.width, cloud.is_dense), (22, 16, False))
        self.assertIn(cloud.height, (1808, 1809))
        data = points_of(cloud)
        self.assertTrue((data["ring"] == np.arange(16)).all())
        misses = np.isnan(data["x"])
        self.assertGreater(misses.sum(), 1000)
        self.assertTrue(np.isnan(data["intensity"][misses]).all())
        self.assertTrue(np.isfinite(data["time"]).all())
        self.assertLess(data["time"].min(), -0.098)
        self.assertGreater(data["time"].max(), 0.0012)
        self.assertLess(data["time"].max(), 0.00133)  # a packet
        hits = ~misses
        elevation = np.degrees(np.arctan2(data["z"], np.hypot(data["x"], data["y"])))
        expected = np.broadcast_to(np.arange(-15, 16, 2), data.shape)
        self.assertLess(np.abs(elevation - expected)[hits].max(), 0.5)  # beams start beside the centre
        # azimuth 0 is +x, clockwise at 10 Hz; a packet is stamped when it is complete, after 24 firings of 55.296 us
        fired_s = stamp_s(cloud) + data["time"].astype(float) - 24 * 55.296e-6
        start_s = fired_s.min()
        azimuth = np.arctan2(data["y"], data["x"])
        self.assertLess(np.abs(wrapped(azimuth + 2 * np.pi * 10 * (fired_s - start_s)))[hits].max(), np.radians(0.05))
        self.assertGreaterEqual(record_ns, stamp_ns(cloud))

    def test_velodyne_scans_have_bins(self):
        self.publish(*OPEN, "--sensor", "VLP-16", "--as", "velodyne")
        scan = self.first("/scan")
        self.assertEqual(scan.header, self.first("/velodyne_points").header)
        self.assertAlmostEqual(scan.angle_min, -math.pi, 6)
        self.assertAlmostEqual(scan.angle_max, math.pi, 6)
        self.assertAlmostEqual(scan.angle_increment, 0.007, 7)
        self.assertEqual((scan.time_increment, scan.range_min, scan.range_max), (0, 0, 200))
        self.assertEqual(len(scan.ranges), 897)
        self.assertTrue(np.isinf(scan.ranges).any())
        cloud = points_of(self.first("/velodyne_points"))[:, 8]
        hits = cloud[np.isfinite(cloud["x"])]
        bins = ((np.arctan2(hits["y"], hits["x"]) + np.float32(np.pi)) / np.float32(0.007)).astype(int)
        for index, x, y in zip(bins, hits["x"], hits["y"], strict=True):
            near = scan.ranges[max(0, index - 1):index + 2]
            self.assertLess(np.abs(near - math.hypot(x, y)).min(), 0.05)

    def test_velodyne_leaves_out_ranges_beyond_its_limits(self):
        self.publish("builtin:box:size=1,1,1", "--eye", "0,0,0", "--ground-truth", "--sensor", "VLP-16", "--as", "velodyne")
        self.assertTrue(np.isnan(points_of(self.first("/velodyne_points"))["x"]).all())  # 0.5 to 0.87 m

    OUSTER = [("x", 0, F32), ("y", 4, F32), ("z", 8, F32), ("intensity", 16, F32), ("t", 20, U32),
              ("reflectivity", 24, U16), ("ring", 26, U16), ("ambient", 28, U16), ("range", 32, U32)]

    def test_ouster_points_are_destaggered_in_the_lidar_frame(self):
        self.publish(*ROOM, "--sensor", "OS1-32", "--as", "ouster")
        record_ns, cloud = self.found["/ouster/points"][0]
        self.assertEqual(cloud.header.frame_id, "os_lidar")
        self.assertEqual(layout(cloud), self.OUSTER)
        self.assertEqual((cloud.point_step, cloud.height, cloud.width), (48, 32, 1024))
        self.assertTrue(cloud.is_dense)
        data = points_of(cloud)
        self.assertTrue((data["ring"] == np.arange(32)[:, None]).all())
        self.assertGreater(data["z"][0].mean(), data["z"][-1].mean())  # row 0 is the highest
        azimuth = np.arctan2(data["y"], data["x"])
        column = -2 * np.pi * np.arange(1024) / 1024  # 0 is +x, clockwise
        self.assertLess(np.abs(wrapped(azimuth - column)).max(), np.radians(0.36 * 1.1))
        self.assertEqual(data["t"].min(), 0)
        self.assertLess(data["t"].max(), 10**8)
        distance = np.sqrt(sum(data[axis].astype(float)**2 for axis in "xyz"))
        self.assertLess(np.abs(distance * 1e3 - data["range"]).max(), 30)  # ranges count from near the axis
        self.assertGreaterEqual(record_ns, stamp_ns(cloud) + int(data["t"].max()))

    def test_ouster_misses_are_nan_with_range_0(self):
        self.publish(*OPEN, "--sensor", "OS1-32", "--as", "ouster")
        cloud = self.first("/ouster/points")
        data = points_of(cloud)
        self.assertFalse(cloud.is_dense)
        misses = np.isnan(data["x"])
        self.assertTrue(misses.any() and not misses.all())
        self.assertTrue((data["range"][misses] == 0).all())
        self.assertTrue((data["range"][~misses] > 0).all())
        self.assertGreater(np.unique(data["t"][misses]).size, 100)

    def test_ouster_frames_images_and_imu(self):
        self.publish(*ROOM, "--sensor", "OS1-32", "--imu", "ICM-20948", "--as", "ouster")
        parent, transform = self.transforms()["os_lidar"]
        self.assertEqual(parent, "os_sensor")
        self.assertEqual((abs(transform.rotation.z), transform.rotation.w), (1, 0))
        self.assertAlmostEqual(transform.translation.z, 0.03618, 9)
        self.assertEqual(self.parents(), {"os_sensor": "base_link", "os_lidar": "os_sensor", "os_imu": "os_sensor"})
        self.assertLess(np.abs(self.matrix("os_lidar")[:3, 3]).max(), 1e-9)  # the origin of the sensor
        self.assertLess(np.abs(self.matrix("os_imu") - np.eye(4)).max(), 1e-9)
        data = points_of(self.first("/ouster/points"))
        ranges = self.first("/ouster/range_image")
        self.assertEqual((ranges.encoding, ranges.height, ranges.width, ranges.header.frame_id),
                         ("mono16", 32, 1024, "os_lidar"))
        pixels = np.frombuffer(bytes(ranges.data), "<u2").reshape(32, 1024)
        self.assertTrue((pixels == (data["range"] + 2) // 4).all())
        for name in ("signal", "reflec", "nearir"):
            self.assertEqual(self.first(f"/ouster/{name}_image").encoding, "mono16")
        self.assertIn("lidar_data_format", self.first("/ouster/metadata").data)
        imu = self.first("/ouster/imu")
        self.assertEqual(imu.header.frame_id, "os_imu")
        self.assertEqual((imu.orientation.x, imu.orientation.w), (0, 1))
        self.assertTrue((imu.orientation_covariance == -1).all())
        self.assertEqual(list(imu.linear_acceleration_covariance), [0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01])
        self.assertEqual(list(imu.angular_velocity_covariance), [6e-4, 0, 0, 0, 6e-4, 0, 0, 0, 6e-4])
        self.assertAlmostEqual(imu.linear_acceleration.z, 9.8, 0)
        self.assertEqual(self.qos["/ouster/points"][0].reliability.name, "BEST_EFFORT")

    def test_ouster_scan_is_reversed(self):
        self.publish(*ROOM, "--sensor", "OS1-32", "--as", "ouster")
        scan = self.first("/ouster/scan")
        self.assertEqual(scan.header.frame_id, "os_lidar")
        self.assertAlmostEqual(scan.angle_increment, 2 * math.pi / 1024, 7)
        self.assertAlmostEqual(scan.time_increment, 0.1 / 1024, 9)
        self.assertAlmostEqual(scan.range_min, 0.1, 6)
        self.assertEqual((scan.range_max, len(scan.ranges)), (120, 1024))
        row = points_of(self.first("/ouster/points"))["range"][0] * 1e-3
        expected = np.roll(row, -512)[::-1]
        self.assertLess(np.abs(scan.ranges - expected).max(), 1e-5)

    def test_livox_messages_have_all_points_and_the_stamp_of_the_first(self):
        self.publish(*OPEN, "--sensor", "Livox-Mid-360", "--imu", "BMI088", "--as", "livox")
        record_ns, message = self.found["/livox/lidar"][0]
        self.assertEqual(type(message).__name__, "livox_ros_driver2__msg__CustomMsg")
        self.assertEqual(message.header.frame_id, "livox_frame")
        self.assertEqual(message.timebase, stamp_ns(message))
        self.assertEqual((message.point_num, len(message.points)), (20000, 20000))
        times = np.array([point.offset_time for point in message.points])
        self.assertEqual(times[0], 0)
        self.assertTrue((np.diff(times.astype(np.int64)) >= 0).all())
        zeros = np.array([point.x == point.y == point.z == 0 for point in message.points])
        self.assertTrue(zeros.any() and not zeros.all())
        self.assertTrue((np.array([point.line for point in message.points]) == np.arange(20000) % 4).all())
        self.assertGreaterEqual(record_ns, message.timebase + times[-1])
        imu = self.first("/livox/imu")
        self.assertEqual(imu.header.frame_id, "livox_frame")
        self.assertAlmostEqual(imu.linear_acceleration.z, 1, 1)  # in g
        self.assertEqual((imu.orientation.w, imu.orientation_covariance[0]), (1, 0))
        self.assertFalse(np.any(imu.linear_acceleration_covariance))
        self.assertEqual(self.parents(), {"livox_frame": "base_link"})

    def test_livox_point_clouds_have_absolute_nanoseconds(self):
        self.publish(*OPEN, "--sensor", "Livox-Mid-360", "--as", "livox", "--layout", "livox")
        cloud = self.first("/livox/lidar")
        self.assertEqual(layout(cloud), [*XYZI, ("tag", 16, U8), ("line", 17, U8), ("timestamp", 18, F64)])
        self.assertEqual((cloud.point_step, cloud.height, cloud.is_dense), (26, 1, True))
        self.assertEqual(points_of(cloud)["timestamp"].min(), stamp_ns(cloud))

    def test_hesai_points_have_the_time_of_their_packet_and_azimuth_0_on_y(self):
        self.publish(*OPEN, "--sensor", "XT32", "--as", "hesai")
        cloud = self.first("/lidar_points")
        self.assertEqual(cloud.header.frame_id, "hesai_lidar")
        self.assertEqual(layout(cloud), [*XYZI, ("ring", 16, U16), ("timestamp", 18, F64)])
        self.assertEqual((cloud.point_step, cloud.height, cloud.is_dense), (26, 1, False))
        data = points_of(cloud)[0]
        self.assertEqual(data.size, 32 * 2000)
        stamps, counts = np.unique(data["timestamp"], return_counts=True)
        self.assertTrue((counts == 32 * 8).all())  # 8 blocks in a packet
        self.assertLess(np.abs(np.diff(stamps) - 8 * 50e-6).max(), 2e-6)
        self.assertLess(abs(data["timestamp"].min() - stamp_s(cloud)), 2e-6)
        zeros = (data["x"] == 0) & (data["y"] == 0) & (data["z"] == 0)
        self.assertTrue(zeros.any() and not zeros.all())
        hits = ~zeros
        azimuth = np.arctan2(data["x"], data["y"])  # 0 is +y, clockwise
        fired_s = np.arange(data.size) // 32 * 50e-6
        self.assertLess(np.abs(wrapped(azimuth - 2 * np.pi * 10 * fired_s))[hits].max(), np.radians(0.3))
        elevation = np.degrees(np.arctan2(data["z"], np.hypot(data["x"], data["y"])))
        self.assertLess(np.abs(elevation - (15 - data["ring"].astype(float)))[hits].max(), 0.05)  # 0 is the highest

    def test_hesai_points_are_at_the_same_place_of_the_rig(self):
        scene = ROOM + ("--sensor", "XT32")
        self.publish(*scene)
        plain = points_of(self.first("/lidar/points"))[0]
        self.publish(*scene, "--layout", "hesai")
        turned = points_of(self.first("/lidar/points"))[0]
        self.assertTrue((turned["x"] == -plain["y"]).all())
        self.assertTrue((turned["y"] == plain["x"]).all())
        pose = self.matrix(self.first("/lidar/points").header.frame_id)
        xyz = np.stack([turned[axis] for axis in "xyz"])
        self.assertLess(np.abs(pose[:3, :3] @ xyz - np.stack([plain[axis] for axis in "xyz"])).max(), 1e-5)

    def test_robosense_points_are_organised_by_columns(self):
        self.publish(*OPEN, "--sensor", "RS-LiDAR-16", "--as", "robosense")
        cloud = self.first("/rslidar_points")
        self.assertEqual(cloud.header.frame_id, "rslidar")
        self.assertEqual(layout(cloud), XYZI)
        self.assertEqual((cloud.point_step, cloud.width, cloud.is_dense), (16, 16, False))
        data = points_of(cloud)
        misses = np.isnan(data["x"])
        self.assertTrue(misses.any() and not misses.all())
        self.assertFalse(np.any(data["intensity"][misses]))
        azimuth = np.arctan2(data["y"], data["x"])[~misses.any(axis=1)]  # of whole columns
        self.assertGreater(len(azimuth), 10)
        steps = np.diff(np.median(azimuth, axis=1))
        self.assertLess(np.median(steps), 0)  # clockwise
        self.publish(*OPEN, "--sensor", "RS-LiDAR-16", "--as", "robosense", "--layout", "robosense")
        self.assertEqual(layout(self.first("/rslidar_points")), [*XYZI, ("ring", 16, U16), ("timestamp", 18, F64)])

    CIRCLE = """models: [{model: "builtin:box:size=20,16,6"}]
sensors: [{name: lidar, sensor: SENSOR, pose: {position: [0.2, 0, 0.3]}}]
imus: [{name: imu, imu: {rate_hz: 200}, pose: {position: [0.2, 0, 0.3]}}]
rig_pose: {position: [1, 0.5, 0]}
rig_motion: {twist: {velocity_m_s: [1, 0, 0], rate_deg_s: [0, 0, 30]}}
"""
    # The time of points in seconds; the units of the IMU.
    MOVING = {
        "velodyne": ("VLP-16", "/velodyne_points", "/imu/data", 1, 1,
                     lambda c, p: stamp_s(c) + p["time"].astype(float) - 24 * 55.296e-6),
        "ouster": ("OS1-32", "/ouster/points", "/ouster/imu", 1, 1, lambda c, p: stamp_s(c) + 1e-9 * p["t"]),
        "livox": ("Livox-Mid-360", "/livox/lidar", "/livox/imu", 9.80665, 1, lambda c, p: 1e-9 * p["timestamp"]),
        "robosense": ("RS-LiDAR-16", "/rslidar_points", "/rslidar_imu_data", 9.80665, 1, lambda c, p: p["timestamp"]),
        "hesai": ("XT32", "/lidar_points", "/lidar_imu", 9.80665, math.radians(1), lambda c, p: p["timestamp"] - 175e-6),
    }

    def test_points_and_imu_samples_follow_from_the_motion(self):
        """A circle of 12 m: points at the true pose of their time are on the walls, and the IMU feels the turn."""
        layouts = {"livox": ("--layout", "livox"), "robosense": ("--layout", "robosense")}
        rate, radius_m = math.radians(30), 1 / math.radians(30)
        for driver, (sensor, topic, imu_topic, gravity, turn, seconds_of) in self.MOVING.items():
            with self.subTest(driver):
                self.write("circle.yaml", self.CIRCLE.replace("SENSOR", sensor))
                self.publish("circle.yaml", "--ground-truth", "--as", driver, *layouts.get(driver, ()), duration="0.2")
                start_s = 1767225600.0
                for moving in ("/tf", imu_topic):  # from the start of the first frame on
                    self.assertEqual(self.found[moving][0][0], 1767225600 * 10**9, moving)
                cloud = self.found[topic][-1][1]
                data = points_of(cloud).ravel()
                xyz = np.stack([data[axis].astype(float) for axis in "xyz"])
                kept = np.isfinite(xyz[0]) & (np.abs(xyz).max(axis=0) > 0)
                angle = rate * (seconds_of(cloud, data)[kept] - start_s)
                pose = self.matrix(cloud.header.frame_id)
                body = pose[:3, :3] @ xyz[:, kept] + pose[:3, 3:]
                world = np.stack([np.cos(angle) * body[0] - np.sin(angle) * body[1] + radius_m * np.sin(angle) + 1,
                                  np.sin(angle) * body[0] + np.cos(angle) * body[1] + radius_m * (1 - np.cos(angle)) + 0.5,
                                  body[2]])
                errors = np.abs(np.abs(world) - np.array([[10], [8], [3]])).min(axis=0)
                self.assertGreater(errors.size, 10_000)
                self.assertLess(errors.max(), 0.006)  # 350 us of a packet; units of intensity and range of the makers
                samples = [message for _, message in self.found[imu_topic]]
                rotation = self.matrix(samples[0].header.frame_id)[:3, :3]
                felt = [np.mean([[getattr(getattr(s, kind), axis) for axis in "xyz"] for s in samples], axis=0)
                        for kind in ("angular_velocity", "linear_acceleration")]
                # -w^2 times the place from the centre of the circle, and gravity
                acceleration = [-0.2 * rate**2, radius_m * rate**2, 9.80665]
                self.assertLess(np.abs(rotation @ felt[0] * turn - [0, 0, rate]).max(), 1e-6)
                self.assertLess(np.abs(rotation @ felt[1] * gravity - acceleration).max(), 1e-5)

    RIG = """models: [{model: "builtin:box:size=20,16,6"}]
sensors:
  - {name: front, sensor: VLP-16, pose: {position: [1, 0, 0]}}
  - {name: rear, sensor: VLP-16, pose: {position: [-1, 0, 0]}}
  - {name: camera, sensor: D435, pose: {position: [0, 0, 1]}}
imus: [{name: imu, imu: BMI088}]
"""

    def test_two_sensors_of_a_driver_have_namespaces(self):
        self.write("rig.yaml", self.RIG)
        self.publish("rig.yaml", "--as", "velodyne", "--as", "camera=realsense")
        self.assertTrue({"/front/velodyne_points", "/rear/velodyne_points", "/front/scan",
                         "/camera/camera/depth/image_rect_raw", "/camera/camera/imu"} <= set(self.found))
        self.assertEqual(self.first("/rear/velodyne_points").header.frame_id, "rear_velodyne")
        self.assertEqual(self.matrix("rear_velodyne")[0, 3], -1)
        self.publish("rig.yaml", "--as", "front=velodyne", "--frame-prefix", "robot1/", duration="0.1")
        self.assertTrue({"/velodyne_points", "/rear/points"} <= set(self.found))
        frames = {name for t in self.first("/tf_static").transforms for name in (t.header.frame_id, t.child_frame_id)}
        self.assertTrue(all(name.startswith("robot1/") for name in frames))
        self.assertEqual(self.first("/velodyne_points").header.frame_id, "robot1/velodyne")

    def test_drivers_must_suit_a_sensor(self):
        room = ("render", *ROOM, "-o", "x.mcap")
        self.assertIn("a spinning LiDAR", self.refused(*room, "--sensor", "D435", "--as", "velodyne"))
        self.assertIn("a scanner with one row", self.refused(*room, "--sensor", "VLP-16", "--as", "rplidar"))
        self.assertIn("did you mean 'velodyne'?", self.refused(*room, "--sensor", "VLP-16", "--as", "velodine"))
        self.assertIn("no such sensor 'top'", self.refused(*room, "--sensor", "VLP-16", "--as", "top=velodyne"))
        self.assertIn("--columns", self.refused(*room, "--sensor", "VLP-16", "--as", "velodyne", "--columns", "xyz"))
        self.assertIn("--as: no output has ROS messages",
                      self.refused("render", *ROOM, "--sensor", "VLP-16", "--as", "velodyne", "-o", "x.pcd"))
        self.assertFalse(Path(self.folder, "x.mcap").exists())


if __name__ == "__main__":
    unittest.main()
