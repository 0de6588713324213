#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads capture files with dpkt and tcpdump: counts, addresses, ports, checksums and times.

usage: capture_readers_test.py PACKET_FILES_PROGRAM
"""

import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from skipping import importing

with importing():
    import dpkt

EPOCH_US = 1_700_001_234_567_891  # kPacketEpoch_ns
DURATION_S = 0.3  # three frames
# The capture files, the bytes of a data packet, and the microseconds from packet to packet.
VELODYNE = {
    "VLP-16": (1206, 1327.104), "VLP-16-dual": (1206, 663.552), "Puck-Hi-Res": (1206, 1327.104),
    "VLP-32C": (1206, 663.552), "VLP-32C-dual": (1206, 331.776), "HDL-32E": (1206, 552.96),
    "HDL-64E-S3": (1206, 288.0), "HDL-64E-S3-dual": (1206, 172.8), "VLS-128": (1206, 159.9),
    "VLS-128-dual": (1206, 53.3),
}
OUSTER = {  # 64 packets of 16 columns are a revolution
    "OS1-128-LEGACY": 24896, "OS1-128-RNG19_RFL8_SIG16_NIR16": 24832, "OS1-128-RNG19_RFL8_SIG16_NIR16_DUAL": 33024,
    "OS1-128-RNG15_RFL8_NIR8": 8448, "OS1-128-RNG19_RFL8_SIG16_NIR16_RGB16": 33024,
    "OS1-128-RNG19_RFL8_SIG16_NIR16_RGB16_DUAL": 41216,
}
FOLDER = None


def checksum(data):
    """RFC 1071; 0 for data that contain their right checksum."""
    total = sum(struct.unpack(f">{(len(data) + 1) // 2}H", data + b"\0" * (len(data) % 2)))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return ~total & 0xFFFF


def datagrams(name):
    """Microseconds, IP header, UDP header and payload of every datagram, with fragments joined and checksums verified."""
    found, parts = [], {}
    with open(FOLDER / f"{name}.pcap", "rb") as file:
        for stamp, data in dpkt.pcap.Reader(file):
            ip = dpkt.ethernet.Ethernet(data).data
            assert isinstance(ip, dpkt.ip.IP) and ip.p == dpkt.ip.IP_PROTO_UDP
            assert checksum(data[14:34]) == 0, "checksum of the IP header"
            body = parts.setdefault(ip.id, bytearray())
            assert len(body) == 8 * ip.offset, "fragments in order"
            body += data[34:]
            if ip.mf:
                continue
            whole = bytes(parts.pop(ip.id))
            udp = dpkt.udp.UDP(whole)
            pseudo = ip.src + ip.dst + struct.pack(">HH", 17, len(whole))
            assert udp.sum != 0 and checksum(pseudo + whole) == 0, "checksum of the datagram"
            assert udp.ulen == len(whole)
            found.append((round(float(stamp) * 1e6), ip, udp, whole[8:]))
    assert not parts, "fragments without their end"
    return found


class Captures(unittest.TestCase):
    def check_times(self, stamps_us, period_us):
        """Packets are captured when they are complete, truncated to microseconds."""
        for k, stamp in enumerate(stamps_us):
            self.assertLess(abs(stamp - (EPOCH_US + (k + 1) * period_us)), 2.0, f"packet {k}")

    def test_velodyne(self):
        for name, (size, period_us) in VELODYNE.items():
            with self.subTest(name):
                found = datagrams(name)
                data = [one for one in found if len(one[3]) == size]
                positions = [one for one in found if len(one[3]) == 512]
                self.assertEqual(len(data) + len(positions), len(found))
                self.assertAlmostEqual(len(data), DURATION_S * 1e6 / period_us, delta=1.01)
                self.assertEqual({(udp.sport, udp.dport) for _, _, udp, _ in data}, {(2368, 2368)})
                self.assertEqual({(udp.sport, udp.dport) for _, _, udp, _ in positions}, {(8308, 8308)})
                self.assertEqual({socket.inet_ntoa(ip.src) for _, ip, _, _ in found}, {"192.168.1.201"})
                self.assertEqual({socket.inet_ntoa(ip.dst) for _, ip, _, _ in found}, {"255.255.255.255"})
                self.check_times([one[0] for one in data], period_us)
                # the packet's own time is that of its first firing
                for stamp, _, _, payload in data:
                    (hour_us,) = struct.unpack_from("<I", payload, 1200)
                    first_us = stamp - period_us + (7 if name.startswith("VLS") else 0)
                    self.assertLess(abs((first_us - hour_us + 1.8e9) % 3.6e9 - 1.8e9), 3.0)

    def test_ouster(self):
        for name, size in OUSTER.items():
            with self.subTest(name):
                found = datagrams(name)
                self.assertEqual(Counter(len(one[3]) for one in found), {size: 192})
                self.assertEqual({(udp.sport, udp.dport) for _, _, udp, _ in found}, {(7502, 7502)})
                self.check_times([one[0] for one in found], 1e5 / 64)

    @unittest.skipUnless(shutil.which("tcpdump"), "no tcpdump; ./dev test installs it")
    def test_tcpdump_finds_every_checksum_right(self):
        for name in [*VELODYNE, "OS1-128-LEGACY"]:
            with self.subTest(name):
                text = subprocess.run(["tcpdump", "-tt", "-n", "-vv", "-r", FOLDER / f"{name}.pcap"], check=True,
                                      capture_output=True, text=True).stdout
                self.assertNotIn("bad", text)
                records = len(re.findall(r"^\d+\.\d{6} ", text, re.MULTILINE))
                with open(FOLDER / f"{name}.pcap", "rb") as file:
                    self.assertEqual(records, sum(1 for _ in dpkt.pcap.Reader(file)))
                if name in VELODYNE:
                    self.assertEqual(text.count("udp sum ok"), records)


if __name__ == "__main__":
    program = sys.argv.pop(1)
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = Path(folder)
        subprocess.run([program, "write", folder], check=True)
        unittest.main()
