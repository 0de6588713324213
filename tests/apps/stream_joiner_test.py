#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream and simulators that send as soon as the handshake is answered: subscriptions travel apart from hands."""

import json
import threading
import time
import unittest

from stream_support import StreamTest

import zmq
from cli_support import free_ports
from stream_client import cloud, pose_message

ROUNDS, TOGETHER, POSES = 3, 10, 20
LONGEST_S = 60


class Simulator(threading.Thread):
    """Comes some time after GLIDAR, opens its ports in either order and some time apart, and sends at once."""

    def __init__(self, context, port, wait_s, apart_s, opens_poses_first):
        super().__init__()
        self.context, self.port, self.wait_s, self.apart_s = context, port, wait_s, apart_s
        self.opens_poses_first, self.was_asked = opens_poses_first, False

    def run(self):
        time.sleep(self.wait_s)
        with self.context.socket(zmq.PUB) as poses, self.context.socket(zmq.REP) as hand:
            poses.linger, hand.linger = 10_000, 10_000
            order = [(poses, self.port), (hand, self.port + 1)]
            for number, (socket, port) in enumerate(order if self.opens_poses_first else order[::-1]):
                time.sleep(number * self.apart_s)
                socket.bind(f"tcp://127.0.0.1:{port}")
            self.was_asked = hand.poll(LONGEST_S * 1000) != 0
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
                          "--physics-port", str(physics), "--hwm", "100", "--stats", name)

    def free_pairs(self, count):
        pairs = set()
        while len(pairs) < count:
            port = free_ports()
            if not any(abs(port - other) < 2 for other in pairs):
                pairs.add(port)
        return sorted(pairs)

    def test_loses_no_pose_of_a_simulator_that_sends_at_once(self):
        for around in range(ROUNDS):
            pairs = self.free_pairs(2 * TOGETHER)
            programs = [self.program(f"{k}.json", pairs[2 * k], pairs[2 * k + 1]) for k in range(TOGETHER)]
            for program in programs:
                self.assertIn("waiting for a simulator", program.stderr.readline())
            simulators = [Simulator(self.context, pairs[2 * k], wait_s=0.15 * k, apart_s=0.2 * (k % 3),
                                    opens_poses_first=(k + around) % 2 == 0) for k in range(TOGETHER)]
            for simulator in simulators:
                simulator.start()
            for simulator in simulators:
                simulator.join()
            for k, program in enumerate(programs):
                self.finished(program, 0)
                stats = json.loads(self.bytes_of(f"{k}.json"))
                self.assertEqual(stats["poses"]["received"], POSES + 1, f"simulator {k} of round {around}")
                self.assertEqual(stats["clouds"]["sent"], POSES)

    def test_loses_none_of_one_that_comes_again(self):
        program, simulator, subscriber = self.in_the_loop("--hwm", "100", "--pub-hwm", "100")
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

    def test_asks_one_that_opens_the_poses_port_after_the_handshake(self):
        program = self.publish("--subscribers", "0", "--physics-port", str(self.physics), "--hwm", "100")
        with self.context.socket(zmq.REP) as hand, self.context.socket(zmq.PUB) as poses:
            hand.bind(f"tcp://127.0.0.1:{self.physics + 1}")
            self.assertTrue(hand.poll(LONGEST_S * 1000))
            hand.recv()
            poses.bind(f"tcp://127.0.0.1:{self.physics}")
            hand.send(b"")
            while program.poll() is None:
                poses.send(b"vKTHXBAI")
                time.sleep(0.05)
        self.finished(program, 0)


if __name__ == "__main__":
    unittest.main()
