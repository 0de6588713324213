#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar stream --udp: packets for drivers. The built program is found in PATH."""

import socket
import threading
import unittest

from cli_support import MAX_WAIT_S, CliTest

VLP16 = ("builtin:box", "--sensor", "VLP-16", "--eye", "0,0,0")
RIG = """models: [{model: builtin:box, pose: {position: [4, 0, 0]}}]
sensors: [{name: front, sensor: VLP-16}, {name: rear, sensor: XT32}]
rig_pose: {position: [0, 0, 0]}
"""


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


class Receiver:
    """Collects the datagrams that arrive at a free port."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.packets = []
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        while packet := self.socket.recv(65536):
            self.packets.append(packet)

    def finish(self):
        """Everything that was sent before; the socket keeps the order."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as last:
            last.sendto(b"", ("127.0.0.1", self.port))
        self.thread.join(MAX_WAIT_S)
        self.socket.close()
        return self.packets


class Udp(CliTest):
    def captured(self, name, size):
        """The payloads of this size in a capture, of one Ethernet frame each."""
        data = self.bytes_of(name)
        found = []
        at = 24
        while at < len(data):
            length = int.from_bytes(data[at + 8:at + 12], "little")
            payload = data[at + 16 + 42:at + 16 + length]
            if len(payload) == size:
                found.append(payload)
            at += 16 + length
        return found

    def test_sends_the_packets_of_the_capture_in_real_time(self):
        data, positions = Receiver(), Receiver()
        self.succeed("stream", *VLP16, "--frames", "3", "--udp", f"127.0.0.1:{data.port}:{positions.port}", "-o", "scan.pcap")
        sent = data.finish()
        self.assertGreater(len(sent), 200)
        self.assertEqual(sent, self.captured("scan.pcap", 1206))
        self.assertEqual(positions.finish(), self.captured("scan.pcap", 512))

    def test_a_rig_sends_the_packets_of_the_named_sensors(self):
        self.write("rig.yaml", RIG)
        front, rear = Receiver(), Receiver()
        self.succeed("stream", "rig.yaml", "--frames", "2", "--udp", f"front=127.0.0.1:{front.port}", "--udp",
                     f"rear=127.0.0.1:{rear.port}")
        self.assertEqual({len(packet) for packet in front.finish()}, {1206})
        self.assertEqual({len(packet) for packet in rear.finish()}, {1080})
        self.assertIn("several sensors with packets: front, rear", self.refused("stream", "rig.yaml", "--udp", "127.0.0.1"))
        self.assertIn("no sensor 'top'", self.refused("stream", "rig.yaml", "--udp", "top=127.0.0.1"))

    def test_a_replay_sends_the_same_packets(self):
        self.succeed("stream", *VLP16, "--frames", "2", "--rate", "max", "--record", "r.jsonl", "-o", "first.pcap")
        receiver = Receiver()
        self.succeed("replay", "r.jsonl", "--rate", "10", "--udp", f"127.0.0.1:{receiver.port}:9", "-o", "again.pcap")
        self.assertEqual(receiver.finish(), self.captured("first.pcap", 1206))
        self.assertEqual(self.bytes_of("again.pcap"), self.bytes_of("first.pcap"))

    def test_attacks_on_the_interface_for_drivers_lose_no_packet(self):
        for sensor, size, valid in (("OS1-32", 6400, b"GET /api/v1/sensor/metadata HTTP/1.1\r\n\r\n"),
                                    ("XT32", 1080, b"\x47\x74\x05\0\0\0\0\0")):
            port, receiver, done = free_port(), Receiver(), threading.Event()
            answers = []
            attacks = [b"", b"GET", b"\0" * 5000, b"\x47\x74\x05\0\xff\xff\xff\xff", b"A" * 100_000, valid]

            def attack(port=port, done=done, attacks=attacks, answers=answers, valid=valid):
                held = []
                while not done.is_set():
                    for data in attacks:
                        try:
                            client = socket.create_connection(("127.0.0.1", port), MAX_WAIT_S)
                            held.append(client)
                            client.sendall(data)
                            if data is valid:
                                answers.append(client.recv(100))
                        except OSError:  # it does not listen yet or any more, or has closed this connection
                            continue
                    while len(held) > 200:
                        held.pop(0).close()
                for client in held:
                    client.close()

            attacker = threading.Thread(target=attack)
            attacker.start()
            self.succeed("stream", "builtin:box", "--sensor", sensor, "--eye", "0,0,0", "--frames", "10", "--udp",
                         f"127.0.0.1:{receiver.port}:9", "--control", f"127.0.0.1:{port}", "-o", "scan.pcap")
            done.set()
            attacker.join(MAX_WAIT_S)
            sent = receiver.finish()
            self.assertTrue(any(answers))
            self.assertGreater(len(sent), 100)
            if size < 1473:  # larger packets are fragmented in the capture
                self.assertEqual(sent, self.captured("scan.pcap", size))
            self.assertEqual({len(packet) for packet in sent}, {size})

    def test_drivers_read_the_sensor_while_packets_are_sent(self):
        port, receiver = free_port(), Receiver()
        done = threading.Event()
        answers = []

        def ask():
            while not done.is_set() and not answers:
                try:
                    with socket.create_connection(("127.0.0.1", port), MAX_WAIT_S) as driver:
                        driver.sendall(b"\x47\x74\x05\0\0\0\0\0")
                        answers.append(driver.recv(65536))
                except ConnectionRefusedError:
                    continue

        driver = threading.Thread(target=ask)
        driver.start()
        self.succeed("stream", "builtin:box", "--sensor", "XT32", "--eye", "0,0,0", "--frames", "20", "--udp",
                     f"127.0.0.1:{receiver.port}", "--control", f"127.0.0.1:{port}")
        done.set()
        driver.join(MAX_WAIT_S)
        self.assertIn(b"Channel,Elevation,Azimuth", answers[0])
        self.assertGreater(len(receiver.finish()), 400)

    def test_livox_packets_are_sent_and_captured(self):
        points, samples = Receiver(), Receiver()
        self.succeed("stream", "builtin:box", "--sensor", "Livox-Mid-40", "--eye", "0,0,0", "--frames", "2", "--imu", "BMI088",
                     "--livox-data-type", "2", "--control", "none", "--udp", f"127.0.0.1:{points.port}:{samples.port}",
                     "-o", "scan.pcap")
        sent = points.finish()
        self.assertEqual(len(sent), 209)  # 20,000 points of 96 each, the last one filled
        self.assertEqual(sent, self.captured("scan.pcap", 804))
        self.assertEqual(samples.finish(), self.captured("scan.pcap", 60))

    def test_addresses_for_drivers_are_checked(self):
        self.assertIn("whose drivers only receive packets",
                      self.refused("stream", *VLP16, "--udp", "127.0.0.1:9:9", "--control", "127.0.0.1"))
        self.assertIn("--udp", self.refused("stream", *VLP16, "-o", "a.pcap", "--control", "127.0.0.1"))
        for address in ("", "127.0.0.1:1:2", "127.0.0.1:0", "=127.0.0.1"):
            self.assertIn("--control", self.refused("stream", *VLP16, "--udp", "127.0.0.1", f"--control={address}"))
        for sensor, address in (("XT32", "192.0.2.99"), ("Livox-Avia", "192.0.2.99"), ("Livox-Avia", "*")):
            self.assertIn("--control, ", self.refused("stream", "builtin:box", "--sensor", sensor, "--eye", "0,0,0", "--udp",
                                                      "127.0.0.1:9", "--control", address))

    def test_sensors_without_packets_and_bad_addresses_are_refused(self):
        self.assertIn("no manufacturer's packets", self.refused("stream", "builtin:box", "--udp", "127.0.0.1"))
        for address in ("", ":2368", "127.0.0.1:0", "127.0.0.1:1:2:3", "127.0.0.1:x", "=127.0.0.1"):
            self.assertIn("--udp", self.refused("stream", *VLP16, f"--udp={address}"))
        for address in ("::1", "[::1]:2368", "fe80:1:2:3:4:5:6:7", "lidar=::1"):
            for options in (["--udp", address], ["--udp", "127.0.0.1", "--control", address]):
                error = self.refused("stream", *VLP16, *options)
                self.assertIn(f"{options[-2]}: '{address}', an IPv6 address; allowed: ", error)
                self.assertIn("with an IPv4 address or the name of a host; for example 127.0.0.1:2368", error)
        self.assertIn("cannot find the address", self.refused("stream", *VLP16, "--udp", "no such host"))


if __name__ == "__main__":
    unittest.main()
