#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream with peers that request too much, send too much, never read, or send garbage."""

import contextlib
import signal
import struct
import sys
import unittest
from pathlib import Path

from stream_support import StreamTest

import zmq
from cli_support import MAX_WAIT_S
from stream_client import cloud
from waiting import wait_for_line, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from hostile import GARBAGE, Peer, part, request  # noqa: E402

SIZE = ("--width", "8", "--height", "8", "--fov", "20")


class LimitsTest(StreamTest):
    def is_cut_off(self, peer, data):
        def is_closed():
            peer.send_some(data)
            return peer.is_closed()
        wait_until(is_closed, "the end of the connection")


class Lockstep(LimitsTest):
    def listen(self, *arguments, size=SIZE):
        program = self.start(self.box, *size, "--lockstep", "tcp://127.0.0.1:*", "--stats", "stats.json", *arguments)
        self.endpoint = wait_for_line(program.stdout, "listening at").split()[-1]
        self.lockstep_port = int(self.endpoint.split(":")[-1])
        return program

    def client(self):
        socket = self.context.socket(zmq.REQ)
        self.addCleanup(socket.close)
        socket.linger, socket.rcvtimeo = 0, 1000 * MAX_WAIT_S
        socket.connect(self.endpoint)
        return socket

    def kind_and_text(self, socket):
        parts = socket.recv_multipart()
        kind = struct.unpack_from("<H", parts[0], 6)[0]
        return kind, parts[1].decode() if kind == 3 else ""

    def is_answered(self, socket):
        socket.send(request())
        return self.kind_and_text(socket)[0] == 2

    def stop(self, program):
        program.send_signal(signal.SIGTERM)
        return self.finished(program, 143)

    def test_a_reply_beyond_the_limit_is_refused_before_it_is_measured(self):
        program = self.listen(size=("--width", "256", "--height", "256"))
        asking, other = self.client(), self.client()
        asking.send(request(65536, [b"xyz", b"true_xyz", b"normal", b"intensity", b"range"]))
        kind, text = self.kind_and_text(asking)
        self.assertEqual(kind, 3)
        for word in ("size of the reply", "294919.5 MiB", "65536 clouds of 65536 points", "at most 1024 (--limit reply-mib)",
                     "request fewer moments or columns"):
            self.assertIn(word, text)
        self.assertTrue(self.is_answered(other))
        self.stop(program)

    def test_the_limit_of_a_reply_is_an_option(self):
        program = self.listen("--limit", "reply-mib=1", "--limit", "requests=4")
        asking = self.client()
        asking.send(request(700))  # of 64 points of 24 bytes, and a head of 120: 1.1 MB
        self.assertIn("at most 1 (--limit reply-mib)", self.kind_and_text(asking)[1])
        asking.send(request(600))
        self.assertEqual(self.kind_and_text(asking)[0], 2)
        self.stop(program)

    def test_a_long_request_does_not_block_others(self):
        program = self.listen()
        long, short = self.client(), self.client()
        long.send(request(60_000))
        for _ in range(10):
            self.assertTrue(self.is_answered(short))
        self.assertFalse(long.poll(0), "the long one was not answered meanwhile")
        self.stop(program)

    def test_a_request_ends_at_its_deadline_with_an_error(self):
        program = self.listen("--limit", "request-s=1", "--limit", "reply-mib=100000", "--limit", "memory-mib=100000",
                              size=("--width", "512", "--height", "512"))
        asking = self.client()
        asking.send(request(10_000))
        kind, text = self.kind_and_text(asking)
        self.assertEqual(kind, 3)
        self.assertRegex(text, r"time: \d+ of 10000 moments are measured after 1 s; allowed: at most 1 .*request-s")
        self.stop(program)

    def test_sigterm_ends_an_open_request_with_an_error(self):
        program = self.listen("--limit", "reply-mib=100000", "--limit", "memory-mib=100000",
                              size=("--width", "512", "--height", "512"))
        asking = self.client()
        self.assertTrue(self.is_answered(asking))
        asking.send(request(10_000))  # over an existing connection, and therefore before the next client's request
        self.assertTrue(self.is_answered(self.client()))  # the request is open
        self.stop(program)
        self.assertEqual(self.kind_and_text(asking), (3, "request: GLIDAR was stopped by a signal"))

    def test_a_message_that_never_ends_is_cut_off(self):
        program = self.listen("--limit", "request-mib=1")
        for socket_type in (b"REQ", b"DEALER"):
            with Peer(self.lockstep_port, socket_type, MAX_WAIT_S) as peer:
                self.is_cut_off(peer, part(b"", more=True) * 100_000)
        self.assertTrue(self.is_answered(self.client()))
        self.assertIn("without a complete message", self.stop(program))
        self.assertGreaterEqual(self.stats()["errors"]["peer cut off"], 1)

    def test_garbage_does_not_affect_replies_to_others(self):
        program = self.listen()
        asking = self.client()
        for k in range(200):
            with Peer(self.lockstep_port, timeout_s=MAX_WAIT_S) as peer:
                peer.send(GARBAGE[k % len(GARBAGE)])
            self.assertTrue(self.is_answered(asking if k % 4 else self.client()), k)
        self.stop(program)

    def test_a_client_that_sends_without_reading_is_refused_and_others_are_answered(self):
        program = self.listen()
        asking = self.client()
        with Peer(self.lockstep_port, b"DEALER", MAX_WAIT_S) as peer:
            for _ in range(20):
                peer.send_some((part(b"", more=True) + part(request())) * 100)
                self.assertTrue(self.is_answered(asking))
        self.assertIn("--limit requests", self.stop(program))


class Streaming(LimitsTest):
    def serve(self, *arguments):
        program = self.publish("--subscribers", "0", "--rate", "20", "--object-rate", "0,0.5,0", *arguments)
        self.reading = self.subscriber()
        self.reading.shake()
        cloud(self.reading.receive())
        return program

    def subscriber_that_tries_again(self, program):
        """A subscriber that opens new sockets if it gets no answer: a server without file descriptors may close its
        connection, and ZeroMQ does not send a request again."""
        found = []

        def answers():
            late = self.subscriber()
            with contextlib.suppress(TimeoutError):
                late.shake(timeout_s=5)
                found.append(late)
                return True
            late.close()
            return False

        wait_until(answers, "an answer to a new subscriber", program)
        return found[0]

    def goes_on(self, count=10):
        for _ in range(count):
            cloud(self.reading.receive())

    def stop(self, program):
        program.send_signal(signal.SIGTERM)
        return self.finished(program, 143)

    def test_too_many_subscriptions_and_long_topics_are_cut_off(self):
        program = self.serve("--limit", "subscriptions=8", "--limit", "topic-bytes=20")
        for parts in (b"".join(part(b"\1" + bytes([65 + k]) * 5) for k in range(40)), part(b"\1" + b"x" * 21),
                      part(b"\5 no subscription"), part(b"\1" + b"x" * 2000)):
            with Peer(self.port, b"SUB", MAX_WAIT_S) as peer:
                peer.send(parts)
                wait_until(peer.is_closed, "the end of the connection", program)
        self.goes_on()
        errors = self.stop(program)
        self.assertIn("more than 8 subscriptions (--limit subscriptions)", errors)
        self.assertEqual(self.stats()["errors"]["subscription limit"], 2)

    def test_messages_that_never_end_are_cut_off_at_both_ports(self):
        program = self.serve()
        for port, socket_type in ((self.port, b"SUB"), (self.port + 1, b"REQ")):
            with Peer(port, socket_type, MAX_WAIT_S) as peer:
                self.is_cut_off(peer, part(b"", more=True) + part(b"\5" * 100, more=True) * 1000)
        self.goes_on()
        self.stop(program)
        self.assertGreaterEqual(self.stats()["errors"]["peer cut off"], 1)

    def test_a_flood_of_handshakes_does_not_stop_the_clouds(self):
        program = self.serve()
        with Peer(self.port + 1, b"DEALER", MAX_WAIT_S) as peer:
            for _ in range(20):
                peer.send_some((part(b"", more=True) + part(b"")) * 1000)
                self.goes_on(2)
        self.subscriber().shake()
        self.stop(program)

    def test_continues_without_file_descriptors_and_reports_it_once(self):
        program = self.start_by(
            "bash", "-c", 'ulimit -n 64; exec glidar "$@"', "-", "stream", self.box, *SIZE, "--port", str(self.port),
            "--subscribers", "0", "--rate", "20", "--object-rate", "0,0.5,0", "--stats", "stats.json", "-o", "a.csv",
            "--threads", "1")
        self.reading = self.subscriber()
        cloud(self.reading.receive())
        idle = []
        for _ in range(100):
            with contextlib.suppress(ConnectionResetError):  # closed by the server during connect
                idle.append(Peer(self.port, timeout_s=MAX_WAIT_S))
        self.goes_on()
        cloud(self.subscriber_that_tries_again(program).receive())
        before = len(self.files())
        wait_until(lambda: len(self.files()) > before + 4, "more files", program)
        for peer in idle:
            peer.socket.close()
        self.assertEqual(self.stop(program).count("file descriptors used up"), 1)
        self.assertIn("file descriptors used up", self.stats()["errors"])

    def test_sigterm_ends_it_although_nobody_reads(self):
        program = self.publish_box("--width", "512", "--height", "512", "--fov", "20", "--subscribers", "0", "--rate",
                                   "max", "--object-rate", "0,0.5,0")
        reading = self.subscriber()
        cloud(reading.receive())
        reading.close()
        with Peer(self.port, b"SUB", MAX_WAIT_S) as deaf:
            deaf.send(part(b"\1c"))
            wait_for_line(program.stderr, "clouds missed")
            self.stop(program)


class Options(StreamTest):
    def test_bad_limits_are_refused(self):
        for text, word in (("reply-mb=4", "did you mean reply-mib"), ("connections=0", "from 1 to"), ("requests", "for example"),
                           ("request-s=soon", "whole number")):
            error = self.refused("stream", self.box, "--port", str(self.port), "--limit", text)
            self.assertIn("--limit", error)
            self.assertIn(word, error)

    def test_the_documentation_lists_every_limit_with_its_default(self):
        docs = (Path(__file__).resolve().parents[2] / "docs" / "link" / "limits.md").read_text(encoding="utf-8")
        refused = self.refused("stream", self.box, "--port", str(self.port), "--limit", "nonsense=1")
        names = refused.split("names: ")[1].split(";")[0].strip().split(", ")
        self.assertGreater(len(names), 8)
        for name in names:
            default = self.refused("stream", self.box, "--limit", name + "=0").split(f"--limit {name}=")[-1].strip()
            self.assertIn(f"- `{name}` ({default}): ", docs)


if __name__ == "__main__":
    unittest.main()
