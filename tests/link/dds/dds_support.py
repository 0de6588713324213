# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Programs beside each other in a domain of DDS of their own."""

import os
import socket
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from skipping import IN_CTEST, skip  # noqa: E402
from waiting import wait_for_line, wait_until  # noqa: E402

PEER = os.environ.get("GLIDAR_DDS_PEER")
RESERVED = []  # sockets that keep domains from other tests


def skip_without(*variables):
    """Ends the test program when a build lacks what these variables name."""
    for variable in variables:
        if variable not in os.environ:
            skip(f"the build has no {variable}", "install the packages of scripts/packages.txt, and " + IN_CTEST)


def free_domain():
    """A domain that no other test of this machine uses, here or in free_domain.hpp."""
    for domain in range(1, 100):
        reserving = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            reserving.bind(("127.0.0.1", 19_000 + domain))
        except OSError:
            reserving.close()
            continue
        RESERVED.append(reserving)
        return domain
    raise AssertionError("all domains of DDS are in use")


class DdsTest(unittest.TestCase):
    def setUp(self):
        self.domain = free_domain()
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def enterContext(self, manager):  # of Python 3.11
        value = manager.__enter__()
        self.addCleanup(manager.__exit__, None, None, None)
        return value

    def start(self, *command):
        program = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True, cwd=self.folder,
                                   env=os.environ | {"ROS_DOMAIN_ID": str(self.domain)})
        self.addCleanup(self.end, program)
        return program

    def peer(self, *arguments):
        return self.start(PEER, *arguments)

    @staticmethod
    def end(program):
        if program.poll() is None:
            program.kill()
        program.wait()
        program.stdin.close()
        program.stdout.close()

    @staticmethod
    def order(program, line):
        program.stdin.write(line + "\n")
        program.stdin.flush()

    def write_until(self, samples, condition):
        """Lets a peer write its samples until the condition holds: it may not know its readers yet."""
        def write():
            self.order(samples, "write")
            wait_for_line(samples.stdout, "written")
            return condition()
        wait_until(write, "messages")

    def finish(self, program):
        """What the program still prints until it ends."""
        rest = program.stdout.read()
        self.assertEqual(program.wait(), 0)
        return rest


def bag_messages(folder):
    """The messages of a bag of rosbag2, by topic, as CDR."""
    messages = {}
    (storage,) = folder.glob("*.db3")
    with sqlite3.connect(storage) as database:
        rows = database.execute("SELECT topics.name, messages.data FROM messages JOIN topics ON topics.id = topic_id "
                                "ORDER BY messages.timestamp")
        for topic, data in rows:
            messages.setdefault(topic, []).append(bytes(data))
    database.close()
    return messages


def same_message(received, expected):
    """Whether two messages in CDR are equal: DDS may pad them to a multiple of 4, and then the header counts the padding."""
    padding = received[len(expected):]
    return received[:2] == expected[:2] and received[4:len(expected)] == expected[4:] \
        and len(padding) <= 3 and not any(padding)


__all__ = ["PEER", "DdsTest", "bag_messages", "free_domain", "same_message", "skip_without", "wait_for_line",
           "wait_until"]
