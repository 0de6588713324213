# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A client of GLIDAR's lock-step protocol (docs/link/lockstep.md), and the state of the simulation that it requests."""

import json
import struct
import subprocess
from dataclasses import dataclass, field

import numpy as np
import zmq

HEAD = "<4s2HQ"
AT_REST = [0.0] * 6


class LockstepError(RuntimeError):
    """GLIDAR refused a request, or does not answer."""


class Client:
    """Requests frames from `glidar stream SCENE --lockstep ENDPOINT`."""

    def __init__(self, endpoint, timeout_ms=60_000):
        self._socket = zmq.Context.instance().socket(zmq.REQ)
        for option, value in ((zmq.RCVTIMEO, timeout_ms), (zmq.LINGER, 0), (zmq.REQ_RELAXED, 1), (zmq.REQ_CORRELATE, 1)):
            self._socket.setsockopt(option, value)
        self._socket.connect(endpoint)

    def close(self):
        self._socket.close()

    def _ask(self, request):
        self._socket.send(request)
        try:
            parts = self._socket.recv_multipart()
        except zmq.Again:
            raise LockstepError("GLIDAR does not answer") from None
        if struct.unpack_from("<H", parts[0], 6)[0] == 3:
            raise LockstepError(parts[1].decode())
        return parts

    def describe(self):
        """The sensors, objects and poses of the scene."""
        return json.loads(self._ask(struct.pack(HEAD, b"GLDR", 1, 0, 1))[1])

    def measure(self, sensor, columns, t_ns, frame, bodies):
        """The columns of a frame, without misses. `bodies`: the rig, then the objects, 13 numbers each."""
        request = struct.pack(HEAD + "6I", b"GLDR", 1, 1, 2, sensor, 1, len(columns), 1, len(bodies) - 1, 0)
        request += b"".join(name.encode().ljust(24, b"\0") for name in columns)
        request += struct.pack("<qQII", t_ns, 1, frame, 0) + np.asarray(bodies, "<f8").tobytes()
        parts = self._ask(request)
        cloud = {}
        for c, data in enumerate(parts[1:]):
            name, kind, numbers = struct.unpack_from("<24s2sH", parts[0], 24 + 32 * c)
            cloud[name.rstrip(b"\0").decode()] = np.frombuffer(data, "<" + kind.decode()).reshape(-1, numbers)
        return cloud


class Server:
    """`glidar stream SCENE --lockstep` at a port of its own, and a client of it."""

    def __init__(self, scene):
        self.client = None
        self._process = subprocess.Popen(["glidar", "stream", str(scene), "--lockstep", "tcp://127.0.0.1:*"],
                                         stdout=subprocess.PIPE, text=True)
        line = self._process.stdout.readline()
        if not line.startswith("listening at "):
            self.stop()
            raise LockstepError(f"GLIDAR did not start with {scene}")
        self.client = Client(line.split()[-1])

    def stop(self):
        if self.client is not None:
            self.client.close()
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()


@dataclass
class World:
    """Time, and position, quaternion (w x y z), rate and velocity of the rig and of every object."""

    names: list
    start: list
    period_ns: int
    frame: int = 0
    bodies: list = field(default_factory=list)

    def __post_init__(self):
        self.reset()

    @property
    def t_ns(self):
        return self.frame * self.period_ns

    def reset(self):
        self.frame = 0
        self.bodies = [list(body) for body in self.start]

    def set_pose(self, name, position, quaternion, velocity=(0, 0, 0), rate=(0, 0, 0)):
        if name not in self.names:
            raise LockstepError(f"no entity '{name}'; known: {' '.join(self.names)}")
        self.bodies[self.names.index(name)] = [*position, *quaternion, *rate, *velocity]


def world_of(description, period_ns):
    """The state at the start: the description's poses, at rest."""
    objects = description["objects"]
    names = ["base_link", *(entry["name"] for entry in objects)]
    poses = [description["world_from_rig"], *(entry["world_from_object"] for entry in objects)]
    return World(names, [[*pose, *AT_REST] for pose in poses], period_ns)
