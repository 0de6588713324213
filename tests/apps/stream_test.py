#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream against a client and a simulator that know the protocol of 2015 alone."""

import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

try:
    import numpy as np
    import zmq
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

from cli_support import CliTest, box_of
from stream_client import SHUTDOWN, Simulator, Subscriber, cloud, free_ports, pose_message

SMALL = ("--width", "32", "--height", "24", "--fov", "20")
FLOAT32 = 2e-6  # of 10 m


def rotation(quaternion):
    """The matrix of w x y z."""
    w, x, y, z = np.array(quaternion) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class StreamTest(CliTest):
    def setUp(self):
        super().setUp()
        self.context = zmq.Context()
        self.addCleanup(self.context.term)
        self.box = self.write("box.obj", box_of(2.0))
        self.port = free_ports()
        self.physics = free_ports()
        while abs(self.physics - self.port) < 2:
            self.physics = free_ports()

    def start(self, *arguments):
        """The running program; whatever happens, it ends with the test."""
        program = subprocess.Popen(["glidar", "stream", *arguments], cwd=self.folder, env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end, program)
        return program

    @staticmethod
    def end(program):
        if program.poll() is None:
            program.kill()
            print(program.args, *program.communicate())
        for pipe in (program.stdout, program.stderr):
            pipe.close()
        program.wait()

    def publish(self, *arguments):
        return self.publish_box(*SMALL, *arguments)

    def publish_box(self, *arguments):
        return self.start(self.box, "--port", str(self.port), "--stats", "stats.json", *arguments)

    def in_the_loop(self, *arguments):
        """The program between a simulator and a subscriber, hands shaken."""
        simulator = self.simulator()
        program = self.publish("--physics-port", str(self.physics), *arguments)
        subscriber = self.subscriber()
        subscriber.shake()
        simulator.shake()
        return program, simulator, subscriber

    def simulator(self):
        while True:
            try:
                simulator = Simulator(self.context, self.physics)
                break
            except zmq.ZMQError:  # the port of the one before is not free yet
                time.sleep(0.1)
        self.addCleanup(simulator.close)
        return simulator

    def subscriber(self, **options):
        subscriber = Subscriber(self.context, self.port, **options)
        self.addCleanup(subscriber.close)
        return subscriber

    def finished(self, program, code):
        out, err = program.communicate(timeout=120)
        self.assertEqual(program.returncode, code, out + err)
        return err

    def stats(self):
        return json.loads(self.bytes_of("stats.json"))


class Clouds(StreamTest):
    def test_come_once_hands_are_shaken_and_end_with_the_shutdown(self):
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
            self.assertTrue(((points[:, 3] > 0) & (points[:, 3] <= 1)).all())
        stats = self.stats()
        self.assertEqual(stats["clouds"]["sent"], 4)
        self.assertEqual(stats["clouds"]["bytes"], sum(9 + points.nbytes for _, points in clouds))
        self.assertEqual(stats["ending"], "all frames are done")
        self.assertLessEqual(stats["latency_ms"]["p50"], stats["latency_ms"]["p99"])

    def test_go_to_every_subscriber_the_same(self):
        program = self.publish("--subscribers", "3", "--rate", "20", "--frames", "5", "--model-dr", "0,1,0")
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

    def test_go_to_who_comes_late_or_does_not_shake_hands(self):
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
        program = self.publish("--pub-rate", "3", "--rate", "max", "--frames", "7")
        subscriber = self.subscriber()
        subscriber.shake()
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [1, 2, 3])
        self.finished(program, 0)
        self.assertEqual(self.stats()["frames"]["measured"], 3)

    def test_do_not_wait_for_a_subscriber_that_never_reads(self):
        program = self.publish_box("--camera-z", "4", "--subscribers", "2",
                               "--rate", "max", "--frames", "120", "--pub-hwm", "2")
        deaf = self.subscriber(rcvhwm=1)
        deaf.shake()
        reader = self.subscriber()
        reader.shake()
        clouds = reader.clouds_until_shutdown()
        err = self.finished(program, 0)
        self.assertGreater(self.stats()["clouds"]["missed"], 0)
        self.assertGreater(len(clouds), 2)
        self.assertIn("clouds missed", err)
        self.assertLess(err.count("\n"), 60)  # one line a second, not one a cloud

    def test_conflated_leave_the_newest_for_a_slow_subscriber(self):
        program = self.publish_box("--camera-z", "4", "--pub-conflate", "1",
                               "--rate", "max", "--frames", "60")
        subscriber = self.subscriber()
        subscriber.shake()
        self.finished(program, 0)
        self.assertEqual(self.stats()["clouds"]["missed"], 0)
        self.assertEqual(self.stats()["clouds"]["sent"], 60)

    def test_go_on_when_a_subscriber_vanishes(self):
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

    def test_are_kept_as_numbered_files_like_those_of_render(self):
        arguments = (self.box, *SMALL, "--model-dr", "0,1,0", "--columns", "xyz,intensity")
        self.succeed("stream", *arguments, "--rate", "max", "--frames", "3", "-o", "a.csv")
        self.succeed("render", *arguments, "--rate", "30", "--duration", "0.1", "-o", "b.csv")
        for k in range(3):
            self.assertEqual(self.bytes_of(f"a_00000{k}.csv"), self.bytes_of(f"b_00000{k}.csv"))

    def test_of_scanners_join_as_those_of_render(self):
        arguments = ("builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0", "--columns", "xyz,time,ring")
        self.succeed("stream", *arguments, "--rate", "max", "--duration", "0.3", "-o", "a.csv")
        self.succeed("render", *arguments, "--duration", "0.3", "-o", "b.csv")
        for k in range(3):
            self.assertEqual(self.bytes_of(f"a_00000{k}.csv"), self.bytes_of(f"b_00000{k}.csv"))
        self.assertFalse(os.path.exists(os.path.join(self.folder, "a_000003.csv")))


class Poses(StreamTest):
    def test_place_object_and_sensor_by_attitudes(self):
        program, simulator, subscriber = self.in_the_loop("--hwm", "100")
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
        program, simulator, subscriber = self.in_the_loop("--hwm", "10")
        simulator.send(pose_message(1, translation=(0.7, 0.3, 10)))
        _, points = cloud(subscriber.receive())
        self.assertGreater(points[:, 0].mean(), 0.3)
        self.assertGreater(points[:, 1].mean(), 0.1)
        simulator.shut_down()
        self.finished(program, 0)

    def test_of_one_timestamp_give_one_cloud(self):
        program, simulator, subscriber = self.in_the_loop("--hwm", "100")
        for stamp in (0, 0, 1, 1, 1, 2):
            simulator.send(pose_message(stamp))
        simulator.shut_down()
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [0, 1, 2])
        self.finished(program, 0)
        self.assertEqual(self.stats()["poses"]["repeated"], 3)

    def test_that_are_none_are_refused_and_counted(self):
        program, simulator, subscriber = self.in_the_loop("--hwm", "1000")
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
        self.assertLess(err.count("pose refused"), 40)

    def test_the_newest_counts_without_a_queue(self):
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

    def test_going_back_in_time_is_told(self):
        program, simulator, subscriber = self.in_the_loop("--hwm", "100")
        for stamp in (7, 3, 4):
            simulator.send(pose_message(stamp))
        simulator.shut_down()
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [7, 3, 4])
        self.assertIn("time went back: from timestamp 7 to 3", self.finished(program, 0))
        self.assertEqual(self.stats()["faults"], {"time went back": 1})

    def test_of_a_simulator_that_comes_back_count_again(self):
        program, simulator, subscriber = self.in_the_loop("--hwm", "10")
        simulator.send(pose_message(1))
        cloud(subscriber.receive())
        simulator.close()
        again = self.simulator()
        again.shake()
        again.send(pose_message(2))
        self.assertEqual(cloud(subscriber.receive())[0], 2)
        again.shut_down()
        self.assertIn("simulator lost", self.finished(program, 0))

    def test_missing_for_too_long_end_it(self):
        program, simulator, subscriber = self.in_the_loop("--pose-timeout", "0.5")
        simulator.send(pose_message(1))
        self.assertEqual([t for t, _ in subscriber.clouds_until_shutdown()], [1])
        self.finished(program, 3)
        self.assertEqual(self.stats()["ending"], "no pose came for 0.5 s")

    def test_of_a_simulator_that_dies_in_the_handshake_are_waited_for(self):
        simulator = self.simulator()
        program = self.publish("--subscribers", "0", "--physics-port", str(self.physics))
        self.assertTrue(simulator.hand.poll(60000))  # asked, and gone without an answer
        simulator.close()
        again = self.simulator()
        again.shake()
        again.shut_down()
        self.finished(program, 0)


class Ends(StreamTest):
    def ends_by(self, program, number, subscriber=None):
        program.send_signal(number)
        if subscriber:
            subscriber.clouds_until_shutdown()
        self.finished(program, 128 + number)
        self.assertEqual(self.stats()["ending"], f"signal {int(number)}")

    def waiting(self, program):
        """Reads the line that says so, which comes once signals are looked after."""
        line = program.stderr.readline()
        self.assertIn("waiting for", line)

    def test_by_a_signal_while_it_waits_for_subscribers(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            program = self.publish("--subscribers", "2")
            self.waiting(program)
            subscriber = self.subscriber()
            subscriber.shake()
            self.ends_by(program, number, subscriber)
            subscriber.close()

    def test_by_a_signal_while_it_waits_for_a_simulator(self):
        program = self.publish("--subscribers", "0", "--physics-port", str(self.physics))
        self.waiting(program)
        self.ends_by(program, signal.SIGINT)

    def test_by_a_signal_while_it_waits_for_poses(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            program, simulator, subscriber = self.in_the_loop()
            self.ends_by(program, number, subscriber)
            simulator.close()
            subscriber.close()
            time.sleep(0.2)

    def test_by_a_signal_in_mid_run(self):
        program = self.publish("--rate", "max")
        subscriber = self.subscriber()
        subscriber.shake()
        cloud(subscriber.receive())
        self.ends_by(program, signal.SIGTERM, subscriber)

    def test_by_a_signal_between_slow_frames(self):
        program = self.publish("--rate", "0.01")
        subscriber = self.subscriber()
        subscriber.shake()
        cloud(subscriber.receive())
        started = time.monotonic()
        self.ends_by(program, signal.SIGINT, subscriber)
        self.assertLess(time.monotonic() - started, 30)

    def test_with_all_three_shutdown_messages_of_2015(self):
        program = self.publish("--rate", "max", "--frames", "1")
        everything = self.subscriber(topic=b"")
        everything.shake()
        last = [everything.receive() for _ in range(4)][1:]
        self.assertEqual(last, [b"pKTHXBAI", b"PKTHXBAI", b"cKTHXBAI"])
        self.assertTrue(all(message[1:] == SHUTDOWN for message in last))
        self.finished(program, 0)


class Documentation(StreamTest):
    def test_has_a_client_and_a_simulator_that_work(self):
        root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
        with open(os.path.join(root, "docs", "link.md"), encoding="utf-8") as file:
            client, simulator = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
        for shown, used in (("5555", self.port), ("5556", self.port + 1), ("5557", self.physics),
                            ("5558", self.physics + 1)):
            client = client.replace(shown, str(used))
            simulator = simulator.replace(shown, str(used))
        self.write("client.py", client)
        self.write("simulator.py", "import struct\nimport zmq\ncontext = zmq.Context()\n" + simulator)
        program = self.publish("--physics-port", str(self.physics), "--hwm", "1000")
        programs = [subprocess.Popen([sys.executable, name], cwd=self.folder, stdout=subprocess.PIPE, text=True)
                    for name in ("simulator.py", "client.py")]
        out = [process.communicate(timeout=60)[0] for process in programs]
        self.finished(program, 0)
        lines = out[1].splitlines()
        self.assertEqual(len(lines), 100)
        self.assertTrue(lines[0].startswith("0 ") and lines[0].endswith(" 9.0"), lines[0])


class Refusals(StreamTest):
    def test_ports_in_use(self):
        taken = self.context.socket(zmq.REP)
        self.addCleanup(taken.close)
        taken.bind(f"tcp://127.0.0.1:{self.port + 1}")
        error = self.refused("stream", self.box, "--port", str(self.port))
        self.assertIn(f"tcp://127.0.0.1:{self.port + 1}", error)
        self.assertIn("another program has this port", error)

    def test_addresses_of_other_machines(self):
        self.assertIn("--bind", self.refused("stream", self.box, "-p", str(self.port), "--bind", "192.0.2.1"))

    def test_streams_that_go_nowhere(self):
        self.assertIn("--port", self.refused("stream", self.box))

    def test_contradictions(self):
        physics = ("stream", self.box, "--port", str(self.port), "--physics-port")
        self.assertIn("overlap", self.refused(*physics, str(self.port + 1)))
        self.assertIn("--model-dr", self.refused(*physics, str(self.physics), "--model-dr", "0,1,0"))
        self.assertIn("--physics-port", self.refused("stream", self.box, "-p", "5555", "--pose-timeout", "1"))

    def test_values_out_of_range(self):
        for option, value in (("--port", "0"), ("--port", "65535"), ("--subscribers", "-1"),
                              ("--pub-rate", "0"), ("--hwm", "x"), ("--rate", "-1"),
                              ("--duration", "nan"), ("--frames", "0"), ("--pub-conflate", "2")):
            arguments = ["stream", self.box, "-o", "a.pcd", option, value]
            self.assertIn(option, self.refused(*arguments))

    def test_statistics_in_a_folder_that_is_not_there(self):
        self.assertIn("--stats", self.refused("stream", self.box, "-o", "a.pcd", "--stats", "no/s.json"))


if __name__ == "__main__":
    unittest.main()
