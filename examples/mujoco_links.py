# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Two clients of `glidar stream` for simulators: in lock-step, and by the original GLIDAR protocol (docs/link.md). Both start
GLIDAR and end it, and measure a sensor and an object that are placed as MuJoCo and most simulators place them."""

import socket
import struct
import subprocess
from dataclasses import dataclass, field

import numpy as np
import zmq

PATIENCE_MS = 60_000


class Trouble(Exception):
    """What a user can do something about."""


@dataclass
class Body:
    """Position, attitude (w x y z, world_from_body), rate and velocity along the world's axes."""

    position: np.ndarray
    quaternion: np.ndarray
    rate: np.ndarray = field(default_factory=lambda: np.zeros(3))
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def pose(self):
        """world_from_body, 4 x 4."""
        pose = np.eye(4)
        pose[:3, :3] = rotation(self.quaternion)
        pose[:3, 3] = self.position
        return pose


def rotation(quaternion):
    """The matrix of w x y z."""
    w, x, y, z = np.asarray(quaternion, float) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Glidar:
    """A running `glidar stream`, which ends with the block that it was started for."""

    def __init__(self, *arguments, **options):
        self.context = zmq.Context()
        try:
            self.program = subprocess.Popen(["glidar", "stream", *arguments], **options)
        except FileNotFoundError:
            raise Trouble("glidar is not in PATH; build it and add its folder: PATH=build/release/apps/glidar:$PATH")

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.context.destroy(linger=0)
        self.program.terminate()
        try:
            self.program.wait(timeout=60)
        except subprocess.TimeoutExpired:
            self.program.kill()
            self.program.wait()
        if self.program.stdout:
            self.program.stdout.close()

    def receive(self, zmq_socket):
        """All parts of the next message."""
        for _ in range(PATIENCE_MS // 100):
            if zmq_socket.poll(100):
                return zmq_socket.recv_multipart()
            if self.program.poll() is not None:
                break
        raise Trouble("glidar ended or does not answer; see its messages above")


class Lockstep(Glidar):
    """Asks for every frame; docs/link/lockstep.md has the tables of bytes."""

    name = "lock-step"

    def __init__(self, model, *arguments):
        super().__init__(model, "--lockstep", "tcp://127.0.0.1:*", *arguments, stdout=subprocess.PIPE, text=True)
        line = self.program.stdout.readline()
        if not line.startswith("listening at "):
            self.__exit__()
            raise Trouble("glidar did not start; see its messages above")
        self.number = 0  # of the frame: its noise
        self.socket = self.context.socket(zmq.REQ)
        self.socket.connect(line.split()[-1])

    def measure(self, t_ns, sensor, target):
        """The hits, N x 3 along the sensor's axes (x right, y down, z forward)."""
        request = struct.pack("<4s2HQ6I24s", b"GLDR", 1, 1, self.number, 0, 1, 1, 1, 1, 0, b"xyz")
        request += struct.pack("<qQII", t_ns, 1, self.number, 0)
        for body in (sensor, target):
            request += np.concatenate([body.position, body.quaternion, body.rate, body.velocity]).tobytes()
        self.number += 1
        self.socket.send(request)
        head, *columns = self.receive(self.socket)
        if struct.unpack_from("<H", head, 6)[0] != 2:
            raise Trouble(columns[0].decode())
        return np.frombuffer(columns[0], "<" + head[48:50].decode()).reshape(-1, 3).astype(float)


def two_ports():
    """A free port whose next one is free too."""
    while True:
        with socket.socket() as first, socket.socket() as second:
            first.bind(("127.0.0.1", 0))
            port = first.getsockname()[1]
            try:
                second.bind(("127.0.0.1", port + 1))
                return port
            except (OSError, OverflowError):
                continue


class Woods2016Protocol(Glidar):
    """Publishes a pose and takes its cloud, as simulators for the original GLIDAR do."""

    name = "woods2016"
    AXES = np.diag([-1.0, -1.0, 1.0])  # x left, y up, z forward, from x right, y down, z forward

    def __init__(self, model, *arguments):
        poses_at = clouds_at = two_ports()
        while abs(clouds_at - poses_at) < 2:
            clouds_at = two_ports()
        super().__init__(model, "--pose-source", f"tcp://127.0.0.1:{poses_at}", "--pose-queue", "100", "--port", str(clouds_at), "--quiet",
                         *arguments)
        try:
            self.poses, self.clouds = self.context.socket(zmq.PUB), self.context.socket(zmq.SUB)
            self.poses.bind(f"tcp://127.0.0.1:{poses_at}")
            self.clouds.subscribe(b"c")
            self.clouds.connect(f"tcp://127.0.0.1:{clouds_at}")
            self.hands = asked, asking = self.context.socket(zmq.REP), self.context.socket(zmq.REQ)
            asked.bind(f"tcp://127.0.0.1:{poses_at + 1}")
            asking.connect(f"tcp://127.0.0.1:{clouds_at + 1}")
            asking.send(b"")
            for hand in (asking, asked):
                self.receive(hand)
            asked.send(b"")
        except BaseException:
            self.__exit__()
            raise

    def measure(self, t_ns, sensor, target):
        """The hits, N x 3 along the sensor's axes (x right, y down, z forward)."""
        w, x, y, z = sensor.quaternion
        attitude = (z, y, -x, w)  # takes inertial vectors into the body, here to x left, y up
        attitude_of_target = target.quaternion * (1, -1, -1, -1)  # the inverse
        numbers = (*attitude_of_target, *(target.position - sensor.position), *attitude)
        self.poses.send(b"v" + struct.pack("<Q11d", t_ns, *numbers))
        message = self.receive(self.clouds)[0]
        if struct.unpack_from("<Q", message, 1)[0] != t_ns:
            raise Trouble("the cloud has another timestamp than the pose")
        return np.frombuffer(message[9:], "<f4").reshape(-1, 4)[:, :3].astype(float) @ self.AXES
