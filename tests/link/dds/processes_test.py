#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writers and readers of ROS 2 topics in processes of their own: slow readers, large clouds, hostile packets."""

import json
import random
import signal
import socket
import unittest

from dds_support import DdsTest, skip_without, wait_for_line, wait_until

skip_without("GLIDAR_DDS_PEER")

LAST = 0xFFFFFFFF
LARGE = 5_800_000  # a frame of 128 channels


class Processes(DdsTest):
    def test_large_clouds_arrive_complete(self):
        reader = self.peer("count", 20, LARGE)
        writer = self.peer("clouds", 20, LARGE, 0)
        self.order(writer, "go")
        self.assertEqual(json.loads(self.finish(reader)), {"complete": 20, "damaged": 0})

    def test_a_stalled_reader_never_blocks_the_writer(self):
        reader = self.peer("newest", 1_000_000)
        writer = self.peer("clouds", 200, 1_000_000, 1000)
        wait_for_line(writer.stdout, "matched")
        reader.send_signal(signal.SIGSTOP)
        self.order(writer, "go")
        self.assertEqual(json.loads(wait_for_line(writer.stdout, "sent"))["sent"], 200)
        reader.send_signal(signal.SIGCONT)
        self.order(reader, "read")
        # it continues with the newest clouds, also if it was given up meanwhile
        wait_until(lambda: (self.order(writer, "last"), reader.poll())[1] is not None, "the newest cloud")
        numbers = [int(line) for line in self.finish(reader).split() if line != "matched"]
        self.assertEqual(numbers[-1], LAST)
        self.assertEqual(numbers, sorted(numbers))

    def test_a_reader_that_is_killed_does_not_end_the_writer(self):
        reader = self.peer("newest", 1000)
        writer = self.peer("clouds", 5, 1000, 100)
        wait_for_line(writer.stdout, "matched")
        reader.kill()
        self.order(writer, "go")
        self.assertEqual(json.loads(wait_for_line(writer.stdout, "sent"))["sent"], 5)

    def test_random_packets_do_not_end_the_program(self):
        writer = self.peer("clouds", 3, 1000, 0)
        dice = random.Random(1)
        base = 7400 + 250 * self.domain  # OMG DDSI-RTPS 2.5, 9.6.2.3
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as attacker:
            for number in range(3000):
                header = b"RTPS\2\3" + dice.choice([b"\1\x10", b"\1\x0f"]) + dice.randbytes(12)
                submessage = bytes([dice.choice([0x01, 0x06, 0x07, 0x08, 0x09, 0x0e, 0x12, 0x13, 0x15, 0x16]),
                                    dice.randrange(256)]) + dice.randbytes(2)
                packet = header + submessage + dice.randbytes(dice.randrange(600)) if number % 4 else dice.randbytes(99)
                for port in (base, base + 10, base + 11):
                    attacker.sendto(packet, ("127.0.0.1", port))
        reader = self.peer("count", 3, 1000)
        self.order(writer, "go")
        self.assertEqual(json.loads(self.finish(reader)), {"complete": 3, "damaged": 0})
        self.assertIsNone(writer.poll())


if __name__ == "__main__":
    unittest.main()
