# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Peers of glidar stream that keep to no rules: TCP connections that speak as much of ZeroMQ's protocol as they need."""

import socket
import struct

GREETING = b"\xff" + bytes(8) + b"\x7f\3\0" + b"NULL".ljust(20, b"\0") + bytes(32)  # https://rfc.zeromq.org/spec/23
GARBAGE = [b"", b"\1\0\2\0a", b"\xff\0\0\0\0", GREETING[:30], GREETING, b"GET / HTTP/1.1\r\n\r\n", bytes(range(256)) * 16]


def part(body, more=False):
    """A part of a message as it is sent."""
    flags = int(more)
    return bytes([flags, len(body)]) + body if len(body) < 256 else struct.pack(">BQ", flags | 2, len(body)) + body


class Peer:
    """A connection; with a socket type, one that completes ZeroMQ's handshake. Raises OSError once it is closed."""

    def __init__(self, port, socket_type=None, timeout_s=5):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout_s)
        if socket_type is not None:
            self.shake(socket_type)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.socket.close()

    def shake(self, socket_type):
        self.send(GREETING)
        self.receive(len(GREETING))
        body = b"\5READY\x0bSocket-Type" + struct.pack(">I", len(socket_type)) + socket_type
        self.send(b"\4" + bytes([len(body)]) + body)
        self.receive(self.receive(2)[1])

    def send(self, data):
        self.socket.sendall(data)

    def receive(self, count):
        data = b""
        while len(data) < count:
            more = self.socket.recv(count - len(data))
            if not more:
                raise ConnectionError("closed")
            data += more
        return data

    def is_closed(self):
        """Whether the other side has closed the connection; what it sent is discarded. Does not wait."""
        self.socket.setblocking(False)
        try:
            while self.socket.recv(1 << 16):
                pass
        except BlockingIOError:
            return False
        except OSError:
            pass
        return True

    def send_some(self, data):
        """Sends as much of it as fits, without waiting."""
        self.socket.setblocking(False)
        try:
            self.socket.send(data)
        except OSError:
            pass


def request(moments=1, columns=(b"xyz",), number=7):
    """A request in lock-step of the same moment again and again: docs/link/lockstep.md."""
    start = struct.pack("<4s2HQ6I", b"GLDR", 1, 1, number, 0, 0, len(columns), moments, 0, 0)
    sensor = struct.pack("<13d", 6, 0, 0, 0.5, -0.5, -0.5, 0.5, 0, 0, 0, 0, 0, 0)
    return start + b"".join(name.ljust(24, b"\0") for name in columns) + (struct.pack("<qQII", 0, 1, 0, 0) + sensor) * moments
