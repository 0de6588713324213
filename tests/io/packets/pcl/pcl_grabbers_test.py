#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The grabbers of PCL read captures and live packets. The built program is found in PATH, the reader in GLIDAR_PCL_READER.

usage: pcl_grabbers_test.py PACKET_FILES_PROGRAM

The grabbers do not turn the head between a block's azimuth and a firing, so the returns are compared where they would be
without that rotation. The second firing in a block of a VLP-16 is half way to the next block, in whole centidegrees."""

import os
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "support"))
from skipping import importing, skip

with importing():
    import numpy as np
    from scipy.spatial import cKDTree

READER = os.environ.get("GLIDAR_PCL_READER", "")
if not READER:
    skip("PCL is not installed", "apt-get install libpcl-dev, which needs 1 to 2 GB, and run ./dev test")

UNIT_M = 0.002
TURN_RATE = 2 * np.pi * 10  # radians per second
SENSORS = {  # preset: reader's name, lasers, seconds from laser to laser and from sequence to sequence
    "VLP-16": ("vlp16", 16, 2.304e-6, 55.296e-6),
    "HDL-32E": ("hdl32", 32, 1.152e-6, 46.08e-6),
}
MAX_WAIT_S = 300
FOLDER = None


def in_our_frame(path):
    """PCL's y is forward and its x is right."""
    points = np.fromfile(path, "<f4").reshape(-1, 4).astype(float)
    return np.column_stack([points[:, 1], -points[:, 0], points[:, 2], points[:, 3]])


def channel_of(points):
    """Number of the channel by elevation, the lowest first."""
    elevation = np.arcsin(points[:, 2] / np.linalg.norm(points[:, :3], axis=1))
    rounded = np.round(np.degrees(elevation) * 3)  # channels are at least 1.33 degrees apart
    steps = np.flatnonzero(np.diff(np.unique(rounded)) > 2)
    return np.searchsorted(np.unique(rounded)[steps], rounded, side="left"), len(steps) + 1


def without_rotation(preset):
    """x y z, channel, stamp in seconds, whether it is in the second firing of a block; of every encoded return."""
    _, lasers, step_s, period_s = SENSORS[preset]
    encoded = np.fromfile(FOLDER / f"{preset}.returns").reshape(-1, 6)
    channel, count = channel_of(encoded)
    assert count == lasers
    laser = np.where(channel < lasers // 2, 2 * channel, 2 * (channel - lasers // 2) + 1)
    turned = TURN_RATE * laser * step_s
    cos, sin = np.cos(turned), np.sin(turned)
    stamp = encoded[:, 3] * 1e-9
    sequence = np.round((stamp - laser * step_s) / period_s).astype(int)
    is_second = (sequence % 2 == 1) & (lasers == 16)
    return np.column_stack([cos * encoded[:, 0] - sin * encoded[:, 1], sin * encoded[:, 0] + cos * encoded[:, 1],
                            encoded[:, 2], channel, stamp, is_second])


class Grabbers(unittest.TestCase):
    def read(self, preset, source, sweeps):
        target = FOLDER / f"{preset}.points"
        subprocess.run([READER, SENSORS[preset][0], source, str(sweeps), target], check=True, timeout=MAX_WAIT_S,
                       stdout=subprocess.DEVNULL)
        return in_our_frame(target)

    def check_capture(self, preset):
        expected = without_rotation(preset)
        found = self.read(preset, FOLDER / f"{preset}.pcap", 2)
        channel, count = channel_of(found)
        self.assertEqual(count, SENSORS[preset][1])
        index, distance = np.zeros(len(found), int), np.zeros(len(found))
        for one in range(count):
            rows, own = np.flatnonzero(channel == one), np.flatnonzero(expected[:, 3] == one)
            # in a scan from rest every direction comes again in the next turn: the first two turns are compared
            own = own[expected[own, 4] < 0.2]
            distance[rows], nearest = cKDTree(expected[own, :3]).query(found[rows, :3])
            index[rows] = own[nearest]
        angle = np.radians(np.where(expected[index, 5] > 0, 0.0205, 0.0105))
        limit = UNIT_M / 2 + angle * np.linalg.norm(found[:, :3], axis=1) + 2e-6
        print(f"{preset}: {len(found)} points, at most {distance.max() * 1e3:.2f} mm")
        self.assertLess((distance - limit).max(), 0.0)
        self.assertLess(abs(len(found) - np.sum(expected[:, 4] < 0.2)), 3 * count)

    def test_vlp16_captures_have_our_points(self):
        self.check_capture("VLP-16")

    def test_hdl32_captures_have_our_points(self):
        self.check_capture("HDL-32E")

    def check_live(self, preset):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        target, capture = FOLDER / "live.points", FOLDER / "live.pcap"
        with subprocess.Popen([READER, SENSORS[preset][0], str(port), "3", target], stdout=subprocess.PIPE,
                              text=True) as reader:
            self.assertEqual(reader.stdout.readline(), "ready\n")
            subprocess.run(["glidar", "stream", "builtin:box:size=20,16,6", "--eye", "1,2,0", "--sensor", preset,
                            "--ground-truth", "--frames", "6", "--udp", f"127.0.0.1:{port}:9", "-o", capture],
                           check=True, timeout=MAX_WAIT_S, capture_output=True)
            self.assertEqual(reader.communicate(timeout=MAX_WAIT_S)[0], "")
        live, stored = in_our_frame(target), self.read(preset, capture, 3)
        # packets may be dropped on a slow machine, as with a real sensor; those that arrive equal those of the capture
        self.assertGreater(len(live), len(stored) // 2)
        self.assertLess(cKDTree(stored).query(live)[0].max(), 1e-9)

    def test_vlp16_live_packets_are_those_of_the_capture(self):
        self.check_live("VLP-16")

    def test_hdl32_live_packets_are_those_of_the_capture(self):
        self.check_live("HDL-32E")


if __name__ == "__main__":
    program = sys.argv.pop(1)
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = Path(folder)
        subprocess.run([program, "write", folder], check=True)
        unittest.main()
