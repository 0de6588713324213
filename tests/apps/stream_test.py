#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream: clouds out and poses in, with a client and a simulator of the original protocol."""

import os
import signal
import unittest

from stream_support import SMALL, StreamTest

import numpy as np
from cli_support import MAX_WAIT_S, tcp
from stream_client import cloud, pose_message

FLOAT32 = 2e-6  # of 10 m
WHITE = 1.2  # the brightest signal of a white surface: ambient 0.2 and diffuse 1 of the light


def rotation(quaternion):
    """The matrix of w x y z."""
    w, x, y, z = np.array(quaternion) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Clouds(StreamTest):
    def test_start_after_the_handshake_and_end_with_the_shutdown(self):
        program = self.publish("--camera-z", "10", "--rate", "max", "--frames", "4")
        subscriber = self.subscriber()
        subscriber.shake()
        clouds = subscriber.clouds_until_shutdown()
        self.finished(program, 0)
        self.assertEqual([timestamp for timestamp, _ in clouds], [1, 2, 3, 4])
        for _, points in clouds:
            self.assertGreater(len(points), 100)
            self.assertLess(np.abs(points[:, 2] - 9.0).max(), FLOAT32)  # the box's front
            self.assertLessEqual(np.abs(points[:, :2]).max(), 1.0)
            self.assertTrue(((points[:, 3] > 0) & (points[:, 3] <= WHITE)).all())
        stats = self.stats()
        self.assertEqual(stats["clouds"]["sent"], 4)
        self.assertEqual(stats["clouds"]["bytes"], sum(9 + points.nbytes for _, points in clouds))
        self.assertEqual(stats["ending"], "all frames are done")
        self.assertLessEqual(stats["latency_ms"]["p50"], stats["latency_ms"]["p99"])

    def test_are_the_same_for_every_subscriber(self):
        program = self.publish("--subscribers", "3", "--rate", "20", "--frames", "5", "--object-rate", "0,1,0")
        subscribers = [self.subscriber() for _ in range(3)]
        for subscriber in subscribers:
            subscriber.shake()
        received = [subscriber.clouds_until_shutdown() for subscriber in subscribers]
        self.finished(program, 0)
        self.assertEqual(self.stats()["clouds"]["handshakes"], 3)
        for clouds in received[1:]:
            self.assertEqual(len(clouds), 5)
            for (stamp, points), (first_stamp, first) in zip(reversed(clouds), reversed(received[0])):
                self.assertEqual(stamp, first_stamp)
                self.assertEqual(points.tobytes(), first.tobytes())

    def test_go_to_late_subscribers_and_to_those_without_handshake(self):
        program = self.publish("--subscribers", "0", "--rate", "20")
        silent = self.subscriber()
        silent.hand.close()
        cloud(silent.receive())
        late = self.subscriber()
        late.shake()
        timestamp, _ = cloud(late.receive())
        self.assertGreater(timestamp, 0)
        program.send_signal(signal.SIGINT)
        for subscriber in (silent, late):
            subscriber.clouds_until_shutdown()
        self.finished(program, 130)

    def test_are_published_every_kth_frame(self):
        program = self.publish("--publish-every", "3", "--rate", "max", "--frames", "7")
        subscriber = self.subscriber()
        subscriber.shake()
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [1, 2, 3])
        self.finished(program, 0)
        self.assertEqual(self.stats()["frames"]["measured"], 3)

    def test_do_not_wait_for_a_subscriber_that_never_reads(self):
        program = self.publish_box("--camera-z", "4", "--subscribers", "2",
                               "--rate", "max", "--frames", "120", "--publish-queue", "2")
        deaf = self.subscriber(rcvhwm=1)
        deaf.shake()
        reader = self.subscriber()
        reader.shake()
        clouds = reader.clouds_until_shutdown()
        err = self.finished(program, 0)
        self.assertGreater(self.stats()["clouds"]["missed"], 0)
        self.assertGreater(len(clouds), 2)
        self.assertIn("clouds missed", err)
        self.assertLess(err.count("\n"), self.stats()["seconds"] + 10)  # one line per second, not one per cloud

    @staticmethod
    def newest_of(subscriber, program):
        """The next message; None if the program has ended and no message came within seconds: on a very busy machine
        ZeroMQ may replace the last one by the end of the connection."""
        while True:
            has_ended = program.poll() is not None
            try:
                return subscriber.receive(timeout_s=2)
            except TimeoutError:
                if has_ended:
                    return None

    def test_publish_latest_keeps_the_newest_for_a_slow_subscriber(self):
        program = self.publish_box("--camera-z", "4", "--publish-latest", "1",
                               "--rate", "max", "--frames", "60")
        subscriber = self.subscriber()
        subscriber.shake()
        received = []
        while (message := self.newest_of(subscriber, program)) not in (b"cKTHXBAI", None):
            received.append(cloud(message)[0])
        self.finished(program, 0)
        self.assertEqual(self.stats()["clouds"]["sent"], 60)
        self.assertTrue(received)
        self.assertEqual(received, sorted(set(received)))  # some may be missing, none is late or repeated

    def test_continue_when_a_subscriber_disappears(self):
        program = self.publish("--subscribers", "2", "--rate", "30")
        gone = self.subscriber()
        gone.shake()
        stays = self.subscriber()
        stays.shake()
        cloud(gone.receive())
        gone.close()
        before, _ = cloud(stays.receive())
        for _ in range(10):
            after, _ = cloud(stays.receive())
        self.assertGreaterEqual(after, before + 10)
        program.send_signal(signal.SIGTERM)
        stays.clouds_until_shutdown()
        self.finished(program, 143)

    def test_are_written_as_numbered_files_like_those_of_render(self):
        arguments = (self.box, *SMALL, "--object-rate", "0,1,0", "--columns", "xyz,intensity")
        self.succeed("stream", *arguments, "--rate", "max", "--frames", "3", "-o", "a.csv")
        self.succeed("render", *arguments, "--rate", "30", "--duration", "0.1", "--per-frame", "-o", "b.csv")
        for k in range(3):
            self.assertEqual(self.bytes_of(f"a_00000{k}.csv"), self.bytes_of(f"b_00000{k}.csv"))

    def test_of_scanners_join_like_those_of_render(self):
        arguments = ("builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--columns", "xyz,time,ring")
        self.succeed("stream", *arguments, "--rate", "max", "--duration", "0.3", "-o", "a.csv")
        self.succeed("render", *arguments, "--duration", "0.3", "--per-frame", "-o", "b.csv")
        for k in range(3):
            self.assertEqual(self.bytes_of(f"a_00000{k}.csv"), self.bytes_of(f"b_00000{k}.csv"))
        self.assertFalse(os.path.exists(os.path.join(self.folder, "a_000003.csv")))


class Poses(StreamTest):
    def test_give_the_attitudes_of_object_and_sensor(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "100")
        random = np.random.default_rng(1)
        for stamp in (5, 2**63 + 3, 2**64 - 1):
            obj = random.normal(size=4)
            obj /= np.linalg.norm(obj)
            sensor = np.array([1.0, 0.02, -0.03, 0.5])
            sensor /= np.linalg.norm(sensor)
            translation = np.array([0.1, -0.2, 10.0])
            simulator.send(pose_message(stamp, obj, translation, sensor))
            timestamp, points = cloud(subscriber.receive())
            self.assertEqual(timestamp, stamp)
            self.assertGreater(len(points), 50)
            inertial = points[:, :3].astype(float) @ rotation(sensor) - translation  # rows: R^T p
            on_box = np.abs(inertial @ rotation(obj).T).max(axis=1)
            self.assertLess(np.abs(on_box - 1.0).max(), 10 * FLOAT32)
        simulator.shut_down()
        subscriber.clouds_until_shutdown()
        self.finished(program, 0)
        self.assertEqual(self.stats()["ending"], "the simulator ended")

    def test_axes_are_left_up_and_forward(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "10")
        simulator.send(pose_message(1, translation=(0.7, 0.3, 10)))
        _, points = cloud(subscriber.receive())
        self.assertGreater(points[:, 0].mean(), 0.3)
        self.assertGreater(points[:, 1].mean(), 0.1)
        simulator.shut_down()
        self.finished(program, 0)

    def test_of_one_timestamp_give_one_cloud(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "100")
        for stamp in (0, 0, 1, 1, 1, 2):
            simulator.send(pose_message(stamp))
        simulator.shut_down()
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [0, 1, 2])
        self.finished(program, 0)
        self.assertEqual(self.stats()["poses"]["repeated"], 3)

    def test_that_are_invalid_are_refused_and_counted(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "1000")
        good = pose_message(1)
        bad = [b"v", good[:-1], good + b"\0", b"v" + bytes(2**20), b"v" + os.urandom(50),
               pose_message(2, obj=(float("nan"), 0, 0, 0)), pose_message(3, sensor=(2, 0, 0, 0)),
               pose_message(4, translation=(0, 0, float("inf"))), pose_message(5, obj=(0, 0, 0, 0))]
        for message in bad * 20:
            simulator.send(message)
        simulator.poses.send_multipart([good, good])
        simulator.send(pose_message(6))
        timestamp, points = cloud(subscriber.receive())
        self.assertEqual(timestamp, 6)
        self.assertLess(np.abs(points[:, 2] - 9.0).max(), FLOAT32)
        simulator.shut_down()
        err = self.finished(program, 0)
        self.assertEqual(self.stats()["poses"]["refused"], 20 * len(bad) + 2)
        self.assertIn("pose refused", err)
        self.assertIn("182 times", err)
        self.assertLess(err.count("pose refused"), self.stats()["seconds"] + 10)

    def test_only_the_newest_is_used_without_a_queue(self):
        program, simulator, subscriber = self.in_the_loop()
        for stamp in range(1, 901):
            simulator.send(pose_message(stamp))
        stamps = [cloud(subscriber.receive())[0]]
        while stamps[-1] != 900:
            stamps.append(cloud(subscriber.receive())[0])
        self.assertEqual(stamps, sorted(stamps))
        self.assertLess(len(stamps), 900)
        simulator.shut_down()
        self.finished(program, 0)

    def test_that_go_back_in_time_are_reported(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "100")
        for stamp in (7, 3, 4):
            simulator.send(pose_message(stamp))
        simulator.shut_down()
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [7, 3, 4])
        self.assertIn("timestamp decreased: from timestamp 7 to 3", self.finished(program, 0))
        self.assertEqual(self.stats()["errors"], {"timestamp decreased": 1})

    def test_of_a_restarted_simulator_are_used(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "10")
        simulator.send(pose_message(1))
        cloud(subscriber.receive())
        simulator.close()
        again = self.simulator()
        again.shake()
        again.send(pose_message(2))
        self.assertEqual(cloud(subscriber.receive())[0], 2)
        again.shut_down()
        self.assertIn("simulator lost", self.finished(program, 0))

    def test_that_are_missing_for_too_long_end_the_stream(self):
        simulator = self.simulator()
        program = self.publish("--pose-source", tcp(self.physics), "--pose-timeout", "3")
        subscriber = self.subscriber()
        subscriber.shake()
        simulator.shake(before_answer=[pose_message(1)])
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [1])
        self.finished(program, 3)
        self.assertEqual(self.stats()["ending"], "no pose came for 3 s")

    def test_of_a_simulator_that_never_answers_end_the_stream_too(self):
        for subscribers in ("0", "1"):
            program = self.publish("--subscribers", subscribers, "--pose-source", tcp(self.physics), "--pose-timeout", "0.1")
            self.finished(program, 3)
            self.assertEqual(self.stats()["ending"], "no simulator answered for 0.1 s")

    def test_of_a_simulator_that_dies_in_the_handshake_are_waited_for(self):
        simulator = self.simulator()
        program = self.publish("--subscribers", "0", "--pose-source", tcp(self.physics))
        self.assertTrue(simulator.hand.poll(1000 * MAX_WAIT_S))  # GLIDAR's request has no answer
        simulator.close()
        again = self.simulator()
        again.shake()
        again.shut_down()
        self.finished(program, 0)


if __name__ == "__main__":
    unittest.main()
