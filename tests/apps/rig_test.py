#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Several sensors on one rig: files, topics and requests of each."""

import json
import os
import struct
import unittest

from stream_support import StreamTest

import numpy as np
from cli_support import tcp
from lockstep_test import CLIENT, Server, body
from stream_client import pose_message

RIG = """models:
  - model: builtin:asteroid
    pose: {position: [6, 0, 0]}
    motion: {spin: {rate_deg_s: [0, 40, 0]}}
sensors:
  - name: lidar
    sensor: VLP-16
    pose: {position: [0, 0, 0.2]}
  - name: camera
    sensor: {optics: {type: pinhole, width: 40, height: 30, fov_deg: 40}, rate_hz: 20, noise: [{type: range_gaussian, sigma_m: 0.01}]}
    pose: {position: [0.1, 0, 0], euler_deg: {roll: -90, yaw: -90}}
  - name: camera_2
    sensor: {optics: {type: pinhole, width: 40, height: 30, fov_deg: 40}, rate_hz: 20, noise: [{type: range_gaussian, sigma_m: 0.01}]}
    pose: {position: [0.1, 0, 0], euler_deg: {roll: -90, yaw: -90}}
rig_pose: {position: [0, 0, 0]}
rig_motion: {twist: {velocity_m_s: [0.5, 0, 0], rate_deg_s: [0, 0, 2]}}
"""


def topic(name):
    return b"/" + name.encode() + b"\0"


class RigTest(StreamTest):
    def setUp(self):
        super().setUp()
        self.write("rig.yaml", RIG)


class Files(RigTest):
    def test_each_sensor_writes_its_own_at_its_own_rate(self):
        self.succeed("render", "rig.yaml", "--duration", "0.1", "--per-frame", "-o", "s.pcd", "--no-sidecar")
        self.assertEqual(self.files(), ["box.obj", "rig.yaml", "s_camera_000000.pcd", "s_camera_000001.pcd",
                                        "s_camera_2_000000.pcd", "s_camera_2_000001.pcd", "s_lidar_000000.pcd"])

    def test_a_sensor_measures_the_same_alone(self):
        self.succeed("render", "rig.yaml", "-o", "all.pcd", "--no-sidecar")
        for name in ("lidar", "camera", "camera_2"):
            self.succeed("render", "rig.yaml", "--sensor-name", name, "-o", "one.pcd", "--no-sidecar")
            self.assertEqual(self.bytes_of("one.pcd"), self.bytes_of(f"all_{name}.pcd"))

    def test_sensors_of_the_same_kind_and_pose_have_different_noise(self):
        self.succeed("render", "rig.yaml", "-o", "all.npz", "--columns", "range,true_range")
        camera, camera_2 = (np.load(os.path.join(self.folder, f"all_{name}.npz")) for name in ("camera", "camera_2"))
        np.testing.assert_array_equal(camera["true_range"], camera_2["true_range"])
        hit = np.isfinite(camera["range"])
        self.assertGreater((camera["range"][hit] != camera_2["range"][hit]).mean(), 0.99)

    def test_a_sensor_moves_with_the_rig(self):
        self.succeed("render", "rig.yaml", "--duration", "0.1", "-o", "s.npz")
        reported = json.loads(self.bytes_of("s_camera_000001.glidar.json"))
        turned = np.deg2rad(2) * 0.05  # a screw motion of 0.5 m/s along x: an arc
        radius = 0.5 / np.deg2rad(2)
        rig = np.array([radius * np.sin(turned), radius * (1 - np.cos(turned)), 0])
        expected = rig + 0.1 * np.array([np.cos(turned), np.sin(turned), 0])
        position = [reported["world_from_sensor"]["position_m"][k] for k in range(3)]
        np.testing.assert_allclose(position, expected, atol=1e-12)

    def test_explain_knows_which_sensor_it_was(self):
        self.succeed("render", "rig.yaml", "-o", "s.pcd")
        reported = self.succeed("explain", "s_camera_2.pcd", "--row", "15", "--col", "20").stdout
        self.assertIn("1200", reported)
        self.assertIn("range_gaussian", reported)

    def test_images_by_ring_are_left_out_for_cameras(self):
        for name in ("b.bev.png", "b.view.png"):
            done = self.succeed("render", "rig.yaml", "--colour-by", "ring", "-o", name)
            self.assertIn(name.replace("b.", "b_lidar."), self.files())
            self.assertNotIn(name.replace("b.", "b_camera."), self.files())
            self.assertIn("camera: a camera has no rings to colour by", done.stderr)
        error = self.refused("render", "rig.yaml", "--sensor-name", "camera", "--colour-by", "ring", "-o", "c.bev.png")
        self.assertIn("a camera has no rings", error)

    def test_a_sensor_given_by_option_replaces_those_of_the_rig(self):
        self.succeed("render", "rig.yaml", "--sensor-name", "lidar", "-o", "one.pcd", "--no-sidecar")
        self.succeed("render", "rig.yaml", "--sensor", "VLP-16", "-o", "new.pcd", "--no-sidecar")
        self.assertEqual(self.bytes_of("new.pcd"), self.bytes_of("one.pcd"))
        self.succeed("render", "rig.yaml", "--sensor", "VLP-16", "--sensor-name", "camera", "-o", "other.pcd")
        placed = json.loads(self.bytes_of("other.glidar.json"))["world_from_sensor"]["position_m"]
        np.testing.assert_allclose(placed, [0.1, 0, 0], atol=1e-12)

    def test_invalid_combinations_are_refused(self):
        reported = self.refused("render", "rig.yaml", "--sensor-name", "radar", "-o", "x.pcd")
        self.assertIn("allowed: lidar, camera, camera_2", reported)
        self.assertIn("a rig of sensors", self.refused("render", "box.obj", "--sensor-name", "a", "-o", "x.pcd"))


class Alone(RigTest):
    def test_a_rig_of_one_keeps_its_name(self):
        self.write("one.yaml", "models: [{model: builtin:box}]\nsensors: [{name: a, sensor: VLP-16}]\n"
                               "rig_pose: {position: [0, 0, 0]}\n")
        self.succeed("render", "one.yaml", "-o", "x.pcd", "--no-sidecar")
        self.assertIn("x_a.pcd", self.files())

    def test_the_second_sensor_rate_rotates_a_lidar_about_up(self):
        """--sensor-rate is about left, up, forward, for any axes of the sensor."""
        self.succeed("render", "box.obj", "--sensor", "VLP-16", "--ground-truth", "--sensor-pose", "0,0,0,1,0,0,0",
                     "--sensor-rate", "0,2,0", "--columns", "sensor_pose", "-o", "x.npz")
        with np.load(os.path.join(self.folder, "x.npz")) as written:
            turns = written["sensor_pose"].reshape(-1, 7)[:, 3:]
        self.assertGreater(turns[:, 3].max(), 0.05)  # about z
        self.assertLess(np.abs(turns[:, 1:3]).max(), 1e-12)


class Topics(RigTest):
    def stream(self, *arguments):
        return self.start("rig.yaml", "--port", str(self.port), "--stats", "stats.json", *arguments)

    def receive_all(self, subscriber, name):
        """(timestamp, points) of a sensor's clouds until its own shutdown."""
        head, found = topic(name), []
        while True:
            message = subscriber.receive()
            self.assertTrue(message.startswith(head), message[:20])
            rest = message[len(head):]
            if rest == b"KTHXBAI":
                return found
            found.append((struct.unpack("<Q", rest[:8])[0], np.frombuffer(rest[8:], "<f4").reshape(-1, 4)))

    def test_are_one_per_sensor_each_at_its_own_rate(self):
        program = self.stream("--subscribers", "2", "--duration", "0.4")
        lidar = self.subscriber(topic=topic("lidar"))
        camera = self.subscriber(topic=topic("camera"))
        for subscriber in (lidar, camera):
            subscriber.shake()
        turns, pictures = self.receive_all(lidar, "lidar"), self.receive_all(camera, "camera")
        self.finished(program, 0)
        self.assertEqual([stamp for stamp, _ in turns], [1, 2, 3, 4])
        self.assertEqual([stamp for stamp, _ in pictures], list(range(1, 9)))
        self.assertEqual(self.stats()["frames"]["measured"], 4 + 8 + 8)
        self.succeed("render", "rig.yaml", "--sensor-name", "camera", "--duration", "0.4", "--frame", "legacy",
                     "--columns", "xyz,intensity", "--drop-invalid", "-o", "c.npz")
        for k, (_, points) in enumerate(pictures):
            with np.load(os.path.join(self.folder, f"c_{k:06}.npz")) as written:
                np.testing.assert_array_equal(points[:, :3], written["xyz"].reshape(-1, 3).astype("<f4"))

    def test_serve_late_and_returning_subscribers(self):
        program = self.stream("--subscribers", "0", "--rate", "20")
        for _ in range(3):
            subscriber = self.subscriber(topic=topic("camera_2"))
            subscriber.shake()
            self.assertTrue(subscriber.receive().startswith(topic("camera_2")))
            subscriber.close()
        program.terminate()
        self.finished(program, 143)

    def test_send_the_end_to_subscribers_of_the_original_topic_too(self):
        program = self.stream("--subscribers", "1", "--frames", "1", "--rate", "max")
        subscriber = self.subscriber()
        subscriber.shake()
        self.assertEqual(subscriber.receive(), b"cKTHXBAI")
        self.finished(program, 0)

    def test_publish_latest_is_refused(self):
        self.assertIn("--publish-latest", self.refused("stream", "rig.yaml", "--port", str(self.port), "--publish-latest", "1"))

    def test_of_a_selected_sensor_is_the_original_one(self):
        program = self.stream("--sensor-name", "camera", "--frames", "2")
        subscriber = self.subscriber()
        subscriber.shake()
        self.assertEqual(len(subscriber.clouds_until_shutdown()), 2)
        self.finished(program, 0)

    def test_have_a_cloud_for_every_pose_of_a_simulator(self):
        rock = "    pose: {position: [6, 0, 0]}\n    motion: {spin: {rate_deg_s: [0, 40, 0]}}\n"
        self.write("rig.yaml", RIG.replace(rock, ""))
        simulator = self.simulator()
        program = self.stream("--pose-source", tcp(self.physics), "--pose-queue", "10", "--subscribers", "2")
        subscribers = {name: self.subscriber(topic=topic(name)) for name in ("lidar", "camera_2")}
        for subscriber in subscribers.values():
            subscriber.shake()
        simulator.shake()
        for stamp in (7, 8, 11):
            simulator.send(pose_message(stamp, translation=(0, 0, 6)))
        simulator.shut_down()
        for name, subscriber in subscribers.items():
            found = self.receive_all(subscriber, name)
            self.assertEqual([stamp for stamp, _ in found], [7, 8, 11])
            self.assertTrue(all(len(points) > 50 for _, points in found), name)
        self.finished(program, 0)


class Requests(RigTest):
    def request(self, sensor, moments, columns=("xyz",)):
        message = bytearray(CLIENT["request"](columns, moments))
        struct.pack_into("<I", message, 16, sensor)
        return bytes(message)

    def test_select_the_sensor_and_give_the_pose_of_the_rig(self):
        with Server(self, "rig.yaml") as server:
            socket = server.connect()
            socket.send(struct.pack("<4s2HQ", b"GLDR", 1, 0, 3))
            reported = json.loads(socket.recv_multipart()[1])
            self.assertEqual([sensor["name"] for sensor in reported["sensors"]], ["lidar", "camera", "camera_2"])
            np.testing.assert_allclose(reported["sensors"][1]["rig_from_sensor"][:3], [0.1, 0, 0])
            rock = body((6, 0, 0))
            for index, sensor in enumerate(reported["sensors"]):
                socket.send(self.request(index, [(0, 1, 0, [body((0, 0, 0)), rock])]))
                _, cloud = CLIENT["clouds"](socket.recv_multipart())[0]
                self.assertEqual(cloud["xyz"].shape[:2], (sensor["rows"], sensor["cols"]))
            self.write("still.yaml", "\n".join(line for line in RIG.splitlines() if "motion" not in line))
            self.succeed("render", "still.yaml", "--sensor-name", "camera_2", "-o", "x.npz")
            with np.load(os.path.join(self.folder, "x.npz")) as written:
                np.testing.assert_array_equal(cloud["xyz"].reshape(written["xyz"].shape), written["xyz"])
            socket.send(self.request(3, [(0, 1, 0, [body((0, 0, 0)), rock])]))
            self.assertIn("sensor: 3; allowed: 0 to 2", socket.recv_multipart()[1].decode())

    def test_sensors_rotate_with_the_rig(self):
        """A wall 20 m ahead of a rotating rig: the sensor's origin moves by rate times lever arm."""
        self.write("wall.yaml", "models: [{model: builtin:plane, scale: 1000}]\n"
                                "sensors: [{name: arm, sensor: VLP-16, pose: {position: [2, 0, 0]}}]\n")
        attitude = (0.7071067811865476, 0, 0.7071067811865476, 0)
        rate = 0.5
        with Server(self, "wall.yaml", "--ground-truth") as server:
            socket = server.connect()
            socket.send(self.request(0, [(0, 1, 0, [body((0, 0, 0), rate=(0, 0, rate)), body((20, 0, 0), attitude)])],
                                     ("azimuth", "elevation", "range", "time")))
            _, cloud = CLIENT["clouds"](socket.recv_multipart())[0]
        t = 1e-9 * cloud["time"][..., 0].astype(float)
        heading = rate * t + cloud["azimuth"][..., 0]
        expected = (20 - 2 * np.cos(rate * t)) / (np.cos(heading) * np.cos(cloud["elevation"][..., 0]))
        hit = np.isfinite(cloud["range"][..., 0])
        self.assertGreater(hit.sum(), 1000)
        np.testing.assert_allclose(cloud["range"][..., 0][hit], expected[hit], rtol=1e-6)


if __name__ == "__main__":
    unittest.main()
