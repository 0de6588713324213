# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A client and a simulator for the original protocol, written from its description only."""

import struct

import numpy as np
import zmq
from cli_support import MAX_WAIT_S

SHUTDOWN = b"KTHXBAI"


class Subscriber:
    """Subscribes to clouds, unless the topic is None, and shakes hands."""

    def __init__(self, context, port, topic=b"c", **options):
        self.clouds = context.socket(zmq.SUB)
        self.clouds.linger = 0
        for name, value in options.items():
            setattr(self.clouds, name, value)
        if topic is not None:
            self.clouds.setsockopt(zmq.SUBSCRIBE, topic)
        self.clouds.connect(f"tcp://127.0.0.1:{port}")
        self.hand = context.socket(zmq.REQ)
        self.hand.linger = 0
        self.hand.connect(f"tcp://127.0.0.1:{port + 1}")
        self.hand.send(b"")

    def shake(self, timeout_s=MAX_WAIT_S):
        if not self.hand.poll(timeout_s * 1000):
            raise TimeoutError("no handshake")
        assert self.hand.recv() == b""

    def receive(self, timeout_s=MAX_WAIT_S):
        """The next raw message."""
        if not self.clouds.poll(timeout_s * 1000):
            raise TimeoutError("no message")
        message = self.clouds.recv()
        assert not self.clouds.getsockopt(zmq.RCVMORE)
        return message

    def clouds_until_shutdown(self, timeout_s=MAX_WAIT_S):
        """(timestamp, N x 4) of every cloud; the last message must be the shutdown."""
        found = []
        while True:
            message = self.receive(timeout_s)
            if message[1:] == SHUTDOWN:
                assert message == b"cKTHXBAI"
                return found
            found.append(cloud(message))

    def close(self):
        self.clouds.close()
        self.hand.close()


def cloud(message):
    assert message[:1] == b"c"
    (timestamp,) = struct.unpack("<Q", message[1:9])
    return timestamp, np.frombuffer(message[9:], "<f4").reshape(-1, 4)


def pose_message(timestamp, obj=(1, 0, 0, 0), translation=(0, 0, 10), sensor=(1, 0, 0, 0)):
    return b"v" + struct.pack("<Q11d", timestamp, *obj, *translation, *sensor)


class Simulator:
    """Publishes poses once GLIDAR has shaken hands."""

    def __init__(self, context, port):
        self.poses = context.socket(zmq.PUB)
        self.poses.linger = 1000
        self.hand = context.socket(zmq.REP)
        self.hand.linger = 0
        try:
            self.poses.bind(f"tcp://127.0.0.1:{port}")
            self.hand.bind(f"tcp://127.0.0.1:{port + 1}")
        except zmq.ZMQError:
            self.close()
            raise

    def shake(self, timeout_s=MAX_WAIT_S, before_answer=()):
        """GLIDAR sends its request after subscribing, so it also gets poses sent before the answer."""
        if not self.hand.poll(timeout_s * 1000):
            raise TimeoutError("no handshake")
        assert self.hand.recv() == b""
        for message in before_answer:
            self.send(message)
        self.hand.send(b"")

    def send(self, message):
        self.poses.send(message)

    def shut_down(self):
        self.poses.send(b"v" + SHUTDOWN)

    def close(self):
        self.poses.close()
        self.hand.close()
