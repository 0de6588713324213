# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream --lockstep with the client of docs/link/lockstep.md."""

import json
import os
import re
import signal
import struct
import subprocess
import sys
import unittest
from pathlib import Path

from cli_support import MAX_WAIT_S, CliTest
from skipping import importing

with importing():
    import numpy as np
    import zmq


DOCS = (Path(__file__).resolve().parents[2] / "docs" / "link" / "lockstep.md").read_text(encoding="utf-8")
EXAMPLE = re.search(r"<!-- run by tests/apps/lockstep_test.py -->\n```python\n(.*?)```", DOCS, re.DOTALL)[1]
CLIENT = {}
exec(EXAMPLE[:EXAMPLE.index("socket = ")], CLIENT)  # the functions of the example

PATIENCE_MS = 1000 * MAX_WAIT_S
SENSOR = [6, 0, 0, 0.5, -0.5, -0.5, 0.5, 0, 0, 0, 0, 0, 0]
ROCK = [0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0]


def body(position, quaternion=(1, 0, 0, 0), rate=(0, 0, 0), velocity=(0, 0, 0)):
    return [*position, *quaternion, *rate, *velocity]


class Server:
    """A context manager for a running glidar stream --lockstep."""

    def __init__(self, test, *arguments, endpoint="tcp://127.0.0.1:*"):
        self.program = subprocess.Popen(
            ["glidar", "stream", *arguments, "--lockstep", endpoint], cwd=test.folder,
            env=test.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.program.stdout.readline()
        assert line.startswith("listening at "), line + self.program.stderr.read()
        self.endpoint = line.split()[-1]
        self._sockets = []

    def __enter__(self):
        return self

    def __exit__(self, *error):
        for socket in self._sockets:
            socket.close()
        if self.program.poll() is None:
            self.program.kill()
        self.program.communicate()

    def connect(self, **options):
        socket = zmq.Context.instance().socket(zmq.REQ)
        socket.setsockopt(zmq.LINGER, 0)
        socket.setsockopt(zmq.RCVTIMEO, PATIENCE_MS)
        for name, value in options.items():
            setattr(socket, name, value)
        socket.connect(self.endpoint)
        self._sockets.append(socket)
        return socket

    def end(self, number=signal.SIGTERM):
        self.program.send_signal(number)
        out, err = self.program.communicate(timeout=MAX_WAIT_S)
        return self.program.returncode, out, err


def ask(socket, columns, moments):
    socket.send(CLIENT["request"](columns, moments))
    return CLIENT["clouds"](socket.recv_multipart())


class Lockstep(CliTest):
    SIZE = ("--width", "48", "--height", "40", "--fov", "30")

    def test_the_documented_client_works(self):
        with Server(self, "builtin:asteroid") as server:
            example = EXAMPLE.replace("tcp://127.0.0.1:5600", server.endpoint)
            done = subprocess.run([sys.executable, "-c", example], capture_output=True, text=True,
                                  timeout=MAX_WAIT_S, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, r"^\d{3,} points\n$")

    def test_a_cloud_is_equal_to_that_of_render(self):
        with Server(self, "builtin:asteroid", *self.SIZE, "--sensor-pose", "9,0,0,1,0,0,0") as server:
            socket = server.connect()
            columns = ["xyz", "intensity", "normal", "status", "instance"]
            _, cloud = ask(socket, columns, [(0, 5, 0, [SENSOR, ROCK])])[0]
        self.succeed("render", "builtin:asteroid", *self.SIZE, "--seed", "5", "--sensor-pose",
                     "6,0,0,0.5,-0.5,-0.5,0.5", "--columns", ",".join(columns), "-o", "x.npz")
        with np.load(os.path.join(self.folder, "x.npz")) as written:
            for name in columns:
                expected = written[name]
                np.testing.assert_array_equal(cloud[name].reshape(expected.shape), expected, name)

    def test_a_batch_is_equal_to_single_requests(self):
        moments = [(k * 1000, k, k, [SENSOR, body((0, 0.1 * k, 0))]) for k in range(70)]
        with Server(self, "builtin:asteroid", *self.SIZE) as server:
            socket = server.connect()
            together = ask(socket, ["xyz"], moments)
            for (stamp, cloud), moment in zip(together, moments):
                alone_stamp, alone = ask(socket, ["xyz"], [moment])[0]
                self.assertEqual(stamp, alone_stamp)
                np.testing.assert_array_equal(cloud["xyz"], alone["xyz"])
        self.assertEqual([stamp for stamp, _ in together], [k * 1000 for k in range(70)])

    def test_beams_see_a_moving_body_at_their_firing_time(self):
        """A wall approaches at 10 m/s: a revolution of 0.1 s measures it up to 1 m closer."""
        with Server(self, "builtin:plane", "--scale", "1000", "--sensor", "VLP-16", "--ground-truth") as server:
            socket = server.connect()
            level = body((0, 0, 0))
            attitude = (0.7071067811865476, 0, 0.7071067811865476, 0)
            wall = body((20, 0, 0), attitude)
            coming = body((20, 0, 0), attitude, velocity=(-10, 0, 0))
            _, at_rest = ask(socket, ["xyz", "time"], [(0, 1, 0, [level, wall])])[0]
            _, moving = ask(socket, ["xyz", "time"], [(0, 1, 0, [level, coming])])[0]
        x = at_rest["xyz"][..., 0]
        seen = np.isfinite(x) & np.isfinite(moving["xyz"][..., 0])
        self.assertGreater(seen.sum(), 1000)
        expected = 20.0 - 10.0 * 1e-9 * moving["time"][..., 0][seen]
        np.testing.assert_allclose(x[seen], 20.0, atol=1e-6)
        np.testing.assert_allclose(moving["xyz"][..., 0][seen], expected, atol=1e-6)

    def test_hits_only_leaves_misses_out(self):
        with Server(self, "builtin:asteroid", *self.SIZE) as server:
            socket = server.connect()
            _, whole = ask(socket, ["xyz"], [(0, 1, 0, [SENSOR, ROCK])])[0]
            message = bytearray(CLIENT["request"](["xyz"], [(0, 1, 0, [SENSOR, ROCK])]))
            struct.pack_into("<I", message, 20, 1)
            socket.send(message)
            _, dense = CLIENT["clouds"](socket.recv_multipart())[0]
        points = whole["xyz"].reshape(-1, 3)
        np.testing.assert_array_equal(dense["xyz"].reshape(-1, 3), points[np.isfinite(points[:, 0])])

    def test_it_describes_itself(self):
        with Server(self, "builtin:asteroid", "--sensor", "OS1-32") as server:
            socket = server.connect()
            socket.send(struct.pack("<4s2HQ", b"GLDR", 1, 0, 3))
            head, text = socket.recv_multipart()
        self.assertEqual(struct.unpack("<4s2HQ", head), (b"GLDR", 1, 4, 3))
        reported = json.loads(text)
        self.assertEqual(reported["sensors"][0]["rows"], 32)
        self.assertEqual(reported["objects"][0]["name"], "asteroid")
        self.assertIn("xyz", reported["columns"])

    def test_bad_requests_get_a_text_error_and_the_next_one_is_answered(self):
        good = CLIENT["request"](["xyz"], [(0, 1, 0, [SENSOR, ROCK])])
        nan = bytearray(good)
        struct.pack_into("<d", nan, 40 + 24 + 24, float("nan"))
        cases = [(b"", "size"), (b"x", "size"), (good[:-1], "size"), (good + b"0", "size"),
                 (b"\xff" * 200, "GLDR"), (bytes(nan), "position"),
                 (CLIENT["request"](["nonsense"], [(0, 1, 0, [SENSOR])]), "nonsense"),
                 (CLIENT["request"](["xyz"], [(0, 1, 0, [SENSOR, ROCK, ROCK])]), "number of objects"),
                 (good[:4] + b"\x09\x00" + good[6:], "version")]
        with Server(self, "builtin:asteroid", *self.SIZE) as server:
            socket = server.connect()
            for message, word in cases:
                with self.subTest(word):
                    socket.send(message)
                    head, text = socket.recv_multipart()
                    self.assertEqual(struct.unpack_from("<H", head, 6)[0], 3)
                    self.assertIn(word, text.decode())
            socket.send_multipart([good, good])
            self.assertIn("several parts", socket.recv_multipart()[1].decode())
            self.assertEqual(len(ask(socket, ["xyz"], [(0, 1, 0, [SENSOR])])), 1)
            code, out, err = server.end()
        self.assertEqual(code, 143)
        self.assertIn("10 refused", out)
        self.assertIn("requests refused", err)

    def test_an_endpoint_in_use_is_refused(self):
        self.write("precious", "kept")
        refused = self.refused("stream", "builtin:asteroid", "--lockstep", f"ipc://{self.folder}/precious")
        self.assertIn("a file that is not a socket has this name", refused)
        self.assertEqual(self.bytes_of("precious"), b"kept")
        endpoint = f"ipc://{self.folder}/link"
        with Server(self, "builtin:asteroid", *self.SIZE, endpoint=endpoint) as server:
            done = self.run_program("stream", "builtin:asteroid", "--lockstep", endpoint)
            self.assertEqual(done.returncode, 2)
            self.assertIn("another program listens there", done.stderr)
            self.assertEqual(len(ask(server.connect(), ["xyz"], [(0, 1, 0, [SENSOR])])), 1)

    def test_several_clients_and_one_that_disappears(self):
        with Server(self, "builtin:asteroid", *self.SIZE) as server:
            for _ in range(20):
                gone = server.connect()
                gone.send(CLIENT["request"](["xyz"], [(0, 1, 0, [SENSOR])] * 40))
                gone.close()
            sockets = [server.connect() for _ in range(5)]
            for k, socket in enumerate(sockets):
                socket.send(CLIENT["request"](["xyz"], [(k, 1, 0, [SENSOR])]))
            for k, socket in enumerate(sockets):
                self.assertEqual(CLIENT["clouds"](socket.recv_multipart())[0][0], k)

    def test_a_client_recovers_after_a_restart_of_glidar(self):
        endpoint = "ipc://" + os.path.join(self.folder, "link")
        moment = [(0, 1, 0, [SENSOR, ROCK])]
        with Server(self, "builtin:asteroid", *self.SIZE, endpoint=endpoint) as server:
            socket = server.connect(req_relaxed=1, req_correlate=1)
            before = ask(socket, ["xyz"], moment)[0][1]["xyz"]
            server.program.kill()
            server.program.wait()
            socket.setsockopt(zmq.RCVTIMEO, 300)
            socket.send(CLIENT["request"](["xyz"], moment))
            with self.assertRaises(zmq.Again):
                socket.recv_multipart()
            with Server(self, "builtin:asteroid", *self.SIZE, endpoint=endpoint):
                socket.setsockopt(zmq.RCVTIMEO, PATIENCE_MS)
                after = ask(socket, ["xyz"], moment)[0][1]["xyz"]
        np.testing.assert_array_equal(before, after)

    def test_keys_are_created_kept_and_required(self):
        with Server(self, "builtin:asteroid", *self.SIZE, "--curve-keys", "keys") as server:
            path = os.path.join(self.folder, "keys")
            self.assertEqual(os.stat(path).st_mode & 0o777, 0o600)
            public = Path(path).read_text(encoding="utf-8").split()[1].encode()
            mine = zmq.curve_keypair()
            socket = server.connect(curve_serverkey=public, curve_publickey=mine[0], curve_secretkey=mine[1])
            self.assertEqual(len(ask(socket, ["xyz"], [(0, 1, 0, [SENSOR])])), 1)
            plain = server.connect()
            plain.setsockopt(zmq.RCVTIMEO, 500)
            plain.send(CLIENT["request"](["xyz"], [(0, 1, 0, [SENSOR])]))
            with self.assertRaises(zmq.Again):
                plain.recv_multipart()
        before = Path(path).read_bytes()
        with Server(self, "builtin:asteroid", *self.SIZE, "--curve-keys", "keys"):
            self.assertEqual(Path(path).read_bytes(), before)
        Path(path).write_text("nonsense", encoding="utf-8")
        self.assertIn("--curve-keys", self.refused("stream", "builtin:box", "--lockstep",
                                                   "tcp://127.0.0.1:*", "--curve-keys", "keys"))

    def test_signals_end_it_with_its_statistics(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with Server(self, "builtin:asteroid", *self.SIZE, "--stats", "stats.json") as server:
                ask(server.connect(), ["xyz"], [(0, 1, 0, [SENSOR])] * 3)
                self.assertEqual(server.end(number)[0], code)
            with open(os.path.join(self.folder, "stats.json"), encoding="utf-8") as text:
                stats = json.load(text)
            self.assertEqual((stats["requests"], stats["clouds"], stats["refused"]), (1, 3, 0))
            self.assertEqual(stats["held_bytes"], 0)
            self.assertGreater(stats["kept_bytes"], 0)

    def test_bad_options_are_refused(self):
        for endpoint, word in (("udp://x:1", "ENDPOINT|tcp://"), ("tcp://127.0.0.1", "tcp://"),
                               ("tcp://127.0.0.1:99999", "65535"), ("ipc://", "path"),
                               ("tcp://192.0.2.1:5600", "192.0.2.1")):
            self.assertRegex(self.refused("stream", "builtin:box", "--lockstep", endpoint), word)
        for more in (["--port", "5555"], ["-o", "x.pcd"], ["--object-rate", "0,0,1"], ["--duration", "1"],
                     ["--drop-invalid"], ["--columns", "xyz"], ["--depth-scale", "5000"]):
            self.assertIn("--lockstep", self.refused("stream", "builtin:box", "--lockstep",
                                                     "tcp://127.0.0.1:*", *more))
        self.assertIn("--curve-keys", self.refused("stream", "builtin:box", "--port", "5555",
                                                   "--curve-keys", "k"))

    def test_a_port_in_use_is_reported(self):
        with Server(self, "builtin:asteroid", *self.SIZE) as server:
            error = self.refused("stream", "builtin:box", "--lockstep", server.endpoint)
        self.assertIn("in use", error)


if __name__ == "__main__":
    unittest.main()
