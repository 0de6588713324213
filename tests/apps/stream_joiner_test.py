#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream and simulators that send right after the handshake, before the subscription may have arrived."""

import json
import threading
import unittest

from stream_support import StreamTest

import zmq
from cli_support import MAX_WAIT_S, free_ports, tcp
from stream_client import SHUTDOWN, cloud, pose_message
from waiting import wait_for_line, wait_until

ROUNDS, TOGETHER, POSES = 3, 10, 20


class Simulator(threading.Thread):
    """Comes after GLIDAR, opens its ports in either order, the second one together with the first or once GLIDAR has
    connected to that, and sends at once."""

    def __init__(self, context, port, is_apart, opens_poses_first):
        super().__init__()
        self.context, self.port, self.is_apart = context, port, is_apart
        self.opens_poses_first, self.was_asked = opens_poses_first, False

    def run(self):
        with self.context.socket(zmq.PUB) as poses, self.context.socket(zmq.REP) as hand:
            poses.linger, hand.linger = 10_000, 10_000
            order = [(poses, self.port), (hand, self.port + 1)]
            (first, first_port), (second, second_port) = order if self.opens_poses_first else order[::-1]
            with first.get_monitor_socket(zmq.EVENT_HANDSHAKE_SUCCEEDED) as connected:
                first.bind(f"tcp://127.0.0.1:{first_port}")
                if self.is_apart and not connected.poll(1000 * MAX_WAIT_S):
                    return
                second.bind(f"tcp://127.0.0.1:{second_port}")
                first.disable_monitor()
            self.was_asked = hand.poll(1000 * MAX_WAIT_S) != 0
            if not self.was_asked:
                return
            hand.recv()
            hand.send(b"")
            for stamp in range(POSES):
                poses.send(pose_message(stamp))
            poses.send(b"vKTHXBAI")


class SlowJoiner(StreamTest):
    def program(self, name, physics, port):
        return self.start(self.box, "--width", "4", "--height", "4", "--port", str(port), "--subscribers", "0",
                          "--pose-source", tcp(physics), "--pose-queue", "100", "--stats", name)

    def test_loses_no_pose_of_a_simulator_that_sends_at_once(self):
        for around in range(ROUNDS):
            pairs = [free_ports() for _ in range(2 * TOGETHER)]
            programs = [self.program(f"{k}.json", pairs[2 * k], pairs[2 * k + 1]) for k in range(TOGETHER)]
            for program in programs:
                wait_for_line(program.stderr, "waiting for a simulator")
            simulators = [Simulator(self.context, pairs[2 * k], is_apart=k % 3 > 0,
                                    opens_poses_first=(k + around) % 2 == 0) for k in range(TOGETHER)]
            for simulator in simulators:
                simulator.start()
            for k, simulator in enumerate(simulators):
                simulator.join()
                self.assertTrue(simulator.was_asked, k)
            for k, program in enumerate(programs):
                self.finished(program, 0)
                stats = json.loads(self.bytes_of(f"{k}.json"))
                self.assertEqual(stats["poses"]["received"], POSES + 1, f"simulator {k} of round {around}")
                self.assertEqual(stats["clouds"]["sent"], POSES)

    def test_loses_no_pose_of_a_restarted_simulator(self):
        program, simulator, subscriber = self.in_the_loop("--pose-queue", "100", "--publish-queue", "100")
        simulator.close()
        for around in range(5):
            again = self.simulator()
            again.shake()
            for stamp in range(100 * around, 100 * around + POSES):
                again.send(pose_message(stamp))
            stamps = [cloud(subscriber.receive())[0] for _ in range(POSES)]
            self.assertEqual(stamps, list(range(100 * around, 100 * around + POSES)))
            if around < 4:
                again.close()
        again.shut_down()
        self.finished(program, 0)

    def test_handshakes_again_when_the_poses_port_opens_late(self):
        program = self.publish("--subscribers", "0", "--pose-source", tcp(self.physics), "--pose-queue", "100")
        with self.context.socket(zmq.REP) as hand, self.context.socket(zmq.PUB) as poses:
            hand.bind(f"tcp://127.0.0.1:{self.physics + 1}")
            self.assertTrue(hand.poll(1000 * MAX_WAIT_S))
            hand.recv()
            poses.bind(f"tcp://127.0.0.1:{self.physics}")
            hand.send(b"")

            def has_ended():
                poses.send(b"v" + SHUTDOWN)
                return program.poll() is not None
            wait_until(has_ended, "the end of the stream")
        self.finished(program, 0)


class LateSubscriber(StreamTest):
    """Shakes hands first and subscribes afterwards."""

    def late(self, before, topic=b"c"):
        """A subscriber that subscribes after its handshake and before()."""
        subscriber = self.subscriber(topic=None)
        subscriber.shake()
        before()
        subscriber.clouds.subscribe(topic)
        return subscriber

    def test_loses_no_cloud_of_a_stream(self):
        program = self.publish("--rate", "max", "--frames", "3", "--subscription-timeout", "1e9")
        late = self.late(lambda: wait_for_line(program.stderr, "waiting for 1 subscriber"))
        self.assertEqual([stamp for stamp, _ in late.clouds_until_shutdown()], [1, 2, 3])
        self.assertNotIn("subscription missing", self.finished(program, 0))

    def test_loses_no_cloud_of_a_replay(self):
        self.succeed("stream", self.box, "--width", "8", "--height", "8", "--frames", "3", "--rate", "max",
                     "--record", "r.jsonl")
        program = self.start("r.jsonl", "--port", str(self.port), "--subscription-timeout", "1e9", command="replay")
        late = self.late(lambda: wait_for_line(program.stderr, "waiting for 1 subscriber"))
        self.assertEqual([stamp for stamp, _ in late.clouds_until_shutdown()], [1, 2, 3])
        self.finished(program, 0)

    def test_loses_no_cloud_of_a_simulators_poses(self):
        simulator = self.simulator()
        program = self.publish("--pose-source", tcp(self.physics), "--pose-queue", "10", "--subscription-timeout", "1e9")

        def send_all():
            simulator.shake(before_answer=[pose_message(stamp) for stamp in (7, 8, 11)])
            simulator.shut_down()
        late = self.late(send_all)
        self.assertEqual([stamp for stamp, _ in late.clouds_until_shutdown()], [7, 8, 11])
        self.finished(program, 0)

    def test_is_waited_for_although_another_one_is_ready(self):
        program = self.publish("--rate", "max", "--frames", "3", "--subscribers", "2", "--subscription-timeout", "1e9")
        early = self.subscriber()
        early.shake()
        late = self.late(lambda: wait_for_line(program.stderr, "1 of 2 subscribers ready"))
        for subscriber in (early, late):
            self.assertEqual([stamp for stamp, _ in subscriber.clouds_until_shutdown()], [1, 2, 3])
        self.finished(program, 0)

    def test_of_one_sensor_of_a_rig_loses_no_cloud_of_it(self):
        self.write("rig.yaml", "models: [{model: box.obj, pose: {position: [6, 0, 0]}}]\n"
                               "sensors: [{name: a, sensor: VLP-16}, {name: b, sensor: VLP-16}]\n"
                               "rig_pose: {position: [0, 0, 0]}\n")
        program = self.start("rig.yaml", "--port", str(self.port), "--frames", "2", "--rate", "max",
                             "--subscription-timeout", "1e9")
        late = self.late(lambda: wait_for_line(program.stderr, "waiting for 1 subscriber"), topic=b"/b\0")
        received = [late.receive() for _ in range(3)]
        self.assertEqual([message[:3] for message in received], [b"/b\0"] * 3)
        self.assertEqual([message[3] for message in received[:2]], [1, 2])
        self.assertEqual(received[2][3:], SHUTDOWN)
        self.finished(program, 0)

    def test_that_never_subscribes_is_reported_once_and_the_stream_continues(self):
        program = self.publish("--rate", "max", "--frames", "3", "--subscription-timeout", "0.2")
        self.subscriber(topic=None).shake()
        err = self.finished(program, 0)
        self.assertEqual(err.count("1 peer has shaken hands but not subscribed to clouds within 0.2 s"), 1, err)
        self.assertEqual(self.stats()["clouds"]["sent"], 3)
        self.assertEqual(self.stats()["errors"], {"subscription missing": 1})

    def test_an_invalid_timeout_is_refused(self):
        for text in ("-1", "nan", "soon"):
            self.assertIn("--subscription-timeout", self.refused("stream", self.box, "--port", str(self.port),
                                                                 "--subscription-timeout", text))


if __name__ == "__main__":
    unittest.main()
