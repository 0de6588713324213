# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Clients of scripts/soak.py that keep to no rules: whatever they do, the others must not notice."""

import contextlib
import struct
import time

import hostile


class HostileClients:
    """For a run with attack_end, findings, endpoint, port and connect(); each client continues until attack_end."""

    def hostile_clients(self):
        return [self.send_garbage, self.send_endless, self.subscribe_without_end, self.hold_connections, self.flood,
                self.ask_for_too_much]

    def attack(self, do, pause_s=0.2):
        """Again and again; a connection that is closed or refused is what should happen."""
        while not self.attack_end.wait(pause_s):
            with contextlib.suppress(OSError):
                do()
            self.findings.add(attacks=1)

    def ports(self):
        """(port, type of socket that may connect to it) of everything that listens."""
        return [(int(self.endpoint.split(":")[-1]), b"DEALER"), (self.port, b"SUB"), (self.port + 1, b"DEALER")]

    def send_garbage(self, _random):
        def do():
            for port, _ in self.ports():
                for garbage in hostile.GARBAGE:
                    with hostile.Peer(port) as peer:
                        peer.send(garbage)
        self.attack(do)

    def send_endless(self, _random):
        small, large = hostile.part(b"", more=True) * 10_000, hostile.part(b"\5" * 1_000_000, more=True)

        def do():
            for port, socket_type in self.ports():
                for data in (small, large):
                    self.send_until_closed(port, socket_type, data)
        self.attack(do)

    def subscribe_without_end(self, random):
        def do():
            topics = [b"\1" + random.bytes(40) for _ in range(2000)]
            self.send_until_closed(self.port, b"SUB", b"".join(map(hostile.part, topics)))
            self.send_until_closed(self.port, b"SUB", hostile.part(b"\1" + random.bytes(900_000)))
        self.attack(do)

    def flood(self, _random):
        """Requests and handshakes of one client that reads no replies, for a second."""
        def do():
            requests = hostile.part(b"", more=True) + hostile.part(hostile.request())
            handshakes = hostile.part(b"", more=True) + hostile.part(b"")
            for (port, socket_type), data in zip(self.ports()[::2], (requests, handshakes)):
                self.send_until_closed(port, socket_type, data * 1000, seconds=1)
        self.attack(do)

    def send_until_closed(self, port, socket_type, data, seconds=5):
        with hostile.Peer(port, socket_type) as peer:
            end = time.monotonic() + seconds
            while time.monotonic() < end and not self.attack_end.is_set() and not peer.is_closed():
                peer.send_some(data)

    def hold_connections(self, _random):
        def do():
            with contextlib.ExitStack() as held:
                for port, _ in self.ports():
                    for _ in range(100):
                        held.enter_context(hostile.Peer(port))
                self.attack_end.wait(2)
        self.attack(do)

    def ask_for_too_much(self, _random):
        columns = [b"xyz", b"true_xyz", b"normal", b"intensity", b"range"]

        def do():
            with self.connect() as client:
                client.send(hostile.request(65536, columns))
                if struct.unpack_from("<H", client.recv_multipart()[0], 6)[0] != 3:
                    raise ValueError("a reply of 19 GB was not refused")
        self.attack(do)
