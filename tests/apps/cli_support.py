# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the built program, found in PATH, in a temporary folder."""

import fcntl
import functools
import os
import random
import re
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from waiting import MAX_WAIT_S  # noqa: E402

BOX = """o box
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 1 5 8 4
"""


RESERVED = []  # files whose locks keep ports from other tests


def free_ports():
    """A free port whose next port is also free, and that no other test gets while this process runs. The range is
    below the ephemeral ports and apart from that of the C++ tests (loopback.hpp)."""
    folder = Path(tempfile.gettempdir(), f"glidar-test-ports-{os.getuid()}")
    folder.mkdir(exist_ok=True)
    while True:
        port = 10_000 + 2 * random.SystemRandom().randrange(5_000)
        lock = open(folder / str(port), "w", encoding="utf-8")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with socket.socket() as first, socket.socket() as second:
                first.bind(("127.0.0.1", port))
                second.bind(("127.0.0.1", port + 1))
        except OSError:
            lock.close()
            continue
        RESERVED.append(lock)
        return port


def tcp(port):
    """The endpoint at a port of this machine."""
    return f"tcp://127.0.0.1:{port}"


def box_of(size):
    """The text of a cube with this side."""
    return re.sub(r"(?m)^v (.*)$", lambda m: "v " + " ".join(
        repr(float(x) * size / 2) for x in m.group(1).split()), BOX)


@functools.cache
def verified(*arguments):
    """A run of `glidar verify`, which takes seconds; the tests of a file share it."""
    return subprocess.run(["glidar", "verify", *arguments], capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)


class CliTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = self._folder.name
        self.environment = dict(os.environ, XDG_CACHE_HOME=os.path.join(self.folder, ".cache"))

    def run_program(self, *arguments):
        done = subprocess.run(["glidar", *arguments], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True, timeout=MAX_WAIT_S, check=False)
        # on systems without Landlock or seccomp, and with sanitizers
        done.stderr = re.sub(r"(?m)^glidar: .*: the import process ran without .*\n", "", done.stderr)
        return done

    def succeed(self, *arguments):
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def verify(self, *arguments):
        done = verified(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def warned(self, *arguments):
        done = self.succeed("render", *arguments, "-o", "x.pcd")
        self.assertIn("glidar: warning:", done.stderr)
        self.assertNotIn("warning", done.stdout)
        return done.stderr

    def refused(self, *arguments):
        """The error of bad input: one line, exit code 2, nothing written."""
        before = sorted(os.listdir(self.folder))
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertTrue(done.stderr.startswith("glidar: error: "), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(done.stdout, "")
        after = [name for name in sorted(os.listdir(self.folder)) if name != ".cache"]
        self.assertEqual(after, [name for name in before if name != ".cache"])
        return done.stderr

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)
        return name

    def bytes_of(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def files(self):
        return sorted(name for name in os.listdir(self.folder) if name != ".cache")
