#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream: its end, its errors, and its documented examples."""

import os
import re
import signal
import subprocess
import sys
import unittest

from stream_support import SMALL, StreamTest

import zmq
from cli_support import MAX_WAIT_S, tcp
from stream_client import SHUTDOWN, cloud, pose_message
from waiting import wait_for_line


RARELY = str(0.1 / MAX_WAIT_S)  # frames per second: no test waits for the second frame


class Ends(StreamTest):
    def ends_by(self, program, number, subscriber=None):
        program.send_signal(number)
        if subscriber:
            subscriber.clouds_until_shutdown()
        self.finished(program, 128 + number)
        words = {signal.SIGINT: "interrupted by Ctrl-C (SIGINT)", signal.SIGTERM: "terminated (SIGTERM)"}
        self.assertEqual(self.stats()["ending"], words[number])

    def waiting(self, program):
        """Reads the line about waiting, which is printed when signals are handled."""
        wait_for_line(program.stderr, "waiting for")

    def test_by_a_signal_while_it_waits_for_subscribers(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            program = self.publish("--subscribers", "2")
            self.waiting(program)
            subscriber = self.subscriber()
            subscriber.shake()
            wait_for_line(program.stderr, "1 of 2 subscribers ready")
            self.ends_by(program, number, subscriber)
            subscriber.close()

    def test_by_a_signal_while_it_waits_for_a_subscription(self):
        program = self.publish("--subscription-timeout", "1e9")
        self.waiting(program)
        subscriber = self.subscriber(topic=b"another")
        subscriber.shake()
        self.ends_by(program, signal.SIGINT)

    def test_by_a_signal_while_it_waits_for_a_simulator(self):
        program = self.publish("--subscribers", "0", "--pose-source", tcp(self.physics))
        self.waiting(program)
        self.ends_by(program, signal.SIGINT)

    def test_by_a_signal_while_it_waits_for_poses(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            program, simulator, subscriber = self.in_the_loop()
            self.ends_by(program, number, subscriber)
            simulator.close()
            subscriber.close()

    def test_by_a_signal_while_streaming(self):
        program = self.publish("--rate", "max")
        subscriber = self.subscriber()
        subscriber.shake()
        cloud(subscriber.receive())
        self.ends_by(program, signal.SIGTERM, subscriber)

    def test_by_a_signal_between_slow_frames(self):
        program = self.publish("--rate", RARELY)
        subscriber = self.subscriber()
        subscriber.shake()
        cloud(subscriber.receive())
        self.ends_by(program, signal.SIGINT, subscriber)
        self.assertEqual(self.stats()["frames"]["measured"], 1)

    def full_disk(self, *arguments):
        """The program with a limit of 1 KiB per file, as on a nearly full disk."""
        program = self.start_by("bash", "-c", 'ulimit -f 1; exec glidar "$@"', "-", "stream", "builtin:box", *SMALL,
                                "--port", str(self.port), "-o", "a.csv", *arguments)
        subscriber = self.subscriber()
        subscriber.shake()
        return program, subscriber

    def test_at_once_when_the_disk_is_full_long_before_the_next_frame(self):
        program, subscriber = self.full_disk("--rate", RARELY)
        self.assertEqual(len(subscriber.clouds_until_shutdown()), 1)
        self.assertRegex(self.finished(program, 2), "a_000000.csv.*File too large")

    def test_at_once_when_the_disk_is_full_and_no_pose_comes(self):
        simulator = self.simulator()
        program, subscriber = self.full_disk("--pose-source", tcp(self.physics), "--pose-queue", "10")
        simulator.shake()
        simulator.send(pose_message(1))
        self.assertEqual(len(subscriber.clouds_until_shutdown()), 1)
        self.assertIn("a_000000.csv", self.finished(program, 2))

    def test_not_by_garbage_at_the_handshake_port(self):
        program = self.publish("--camera-z", "10", "--subscribers", "0", "--rate", "20")
        subscriber = self.subscriber()
        cloud(subscriber.receive())
        for parts in ([b"", b"x"], [b"x"], [b"", b"", b""]):
            with self.context.socket(zmq.REQ) as stranger:
                stranger.linger = 0
                stranger.connect(f"tcp://127.0.0.1:{self.port + 1}")
                stranger.send_multipart(parts)
                self.assertTrue(stranger.poll(1000 * MAX_WAIT_S), parts)
                self.assertEqual(stranger.recv(), b"")
        program.send_signal(signal.SIGTERM)
        subscriber.clouds_until_shutdown()
        self.assertIn("unexpected handshake", self.finished(program, 143))

    def test_not_by_a_pose_that_was_queued_longer_than_the_timeout(self):
        """The timeout is about waiting for a pose, not about frames that take long. Poses are sent before the
        handshake is answered, as a busy machine may need long between the two."""
        simulator = self.simulator()
        program = self.publish("--pose-source", tcp(self.physics), "--pose-queue", "10", "--subscribers", "0",
                               "--rate", "0.45", "--pose-timeout", "2", "--frames", "2")
        simulator.shake(before_answer=[pose_message(stamp) for stamp in range(2)])
        self.finished(program, 0)
        self.assertEqual(self.stats()["ending"], "all frames are done")

    def test_with_all_three_shutdown_messages_of_the_original(self):
        program = self.publish("--rate", "max", "--frames", "1")
        everything = self.subscriber(topic=b"")
        everything.shake()
        last = [everything.receive() for _ in range(4)][1:]
        self.assertEqual(last, [b"pKTHXBAI", b"PKTHXBAI", b"cKTHXBAI"])
        self.assertTrue(all(message[1:] == SHUTDOWN for message in last))
        self.finished(program, 0)


class Summaries(StreamTest):
    def test_name_the_written_files(self):
        run = ("stream", self.box, *SMALL, "--camera-z", "10", "--rate", "max")
        many = self.succeed(*run, "--frames", "3", "-o", "a.pcd", "-o", "b.csv", "-o", "c.mcap").stdout
        self.assertIn("\nwrote a_000000.pcd to b_000002.csv (6 files)\nwrote c.mcap\n", many)
        self.assertIn("\nwrote a_000000.pcd\n", self.succeed(*run, "--frames", "1", "-o", "a.pcd").stdout)
        self.assertNotIn("wrote", self.succeed(*run, "--frames", "1", "--record", "r.jsonl").stdout)


class Documentation(StreamTest):
    def test_has_a_working_client_and_simulator(self):
        root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
        with open(os.path.join(root, "docs", "link", "woods2016-protocol.md"), encoding="utf-8") as file:
            client, simulator = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)[:2]
        for shown, used in (("5555", self.port), ("5556", self.port + 1), ("5557", self.physics),
                            ("5558", self.physics + 1)):
            client = client.replace(shown, str(used))
            simulator = simulator.replace(shown, str(used))
        self.write("client.py", client)
        self.write("simulator.py", "import struct\nimport zmq\ncontext = zmq.Context()\n" + simulator)
        program = self.publish("--pose-source", tcp(self.physics), "--pose-queue", "1000", "--publish-queue", "1000")
        programs = [subprocess.Popen([sys.executable, name], cwd=self.folder, stdout=subprocess.PIPE, text=True)
                    for name in ("simulator.py", "client.py")]
        for process in programs:
            self.addCleanup(process.kill)
        out = [process.communicate(timeout=MAX_WAIT_S)[0] for process in programs]
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
        self.assertIn("another program uses this port", error)

    def test_addresses_of_other_machines(self):
        self.assertIn("--bind", self.refused("stream", self.box, "-p", str(self.port), "--bind", "192.0.2.1"))

    def test_streams_without_output(self):
        self.assertIn("--port", self.refused("stream", self.box))

    def test_options_of_files_that_are_not_written(self):
        for option in (["--drop-invalid"], ["--layout", "velodyne"], ["--no-sidecar"]):
            self.assertIn("--output: not given", self.refused("stream", self.box, "--port", str(self.port), *option))

    def test_options_that_exclude_each_other(self):
        physics = ("stream", self.box, "--port", str(self.port), "--pose-source")
        self.assertIn("overlap", self.refused(*physics, tcp(self.port + 1)))
        self.assertIn("--object-rate", self.refused(*physics, tcp(self.physics), "--object-rate", "0,1,0"))
        for endpoint in ("127.0.0.1:5557", "tcp://127.0.0.1:*", "tcp://127.0.0.1:65535", "ipc://poses"):
            error = self.refused(*physics, endpoint)
            self.assertIn("allowed: tcp://HOST:PORT", error)
            self.assertIn("ros2: and a topic with poses or the clock; for example tcp://127.0.0.1:5557 or ros2:/odom", error)
        self.assertIn("--pose-source", self.refused("stream", self.box, "-p", "5555", "--pose-timeout", "1"))

    def test_values_out_of_range(self):
        for option, value in (("--port", "0"), ("--port", "65535"), ("--subscribers", "-1"),
                              ("--publish-every", "0"), ("--pose-queue", "x"), ("--rate", "-1"),
                              ("--duration", "nan"), ("--frames", "0"), ("--publish-latest", "2")):
            arguments = ["stream", self.box, "-o", "a.pcd", option, value]
            self.assertIn(option, self.refused(*arguments))

    def test_statistics_in_a_missing_folder(self):
        self.assertIn("--stats", self.refused("stream", self.box, "-o", "a.pcd", "--stats", "no/s.json"))


if __name__ == "__main__":
    unittest.main()
