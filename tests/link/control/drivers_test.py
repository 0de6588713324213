#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Drivers that start from the address of a simulated sensor alone: ouster-sdk (HTTP), Livox SDK 2 (commands), and hydra4
with the angles that PTC returns. Runs in a network namespace of its own, where port 80 is free and permitted and
broadcasts reach the sensor. The built program is found in PATH.
"""

import ctypes
import csv
import io
import json
import os
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import urllib.request
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from skipping import importing, skip

with importing():
    import livox_sdk
    import numpy as np
    from hydra4.decoders.pandar_xt32 import PandarXT32
    from hydra4.msgs import pandar_msgs__msg__PandarPacket
    from ouster.sdk import open_source
    from ouster.sdk.core import XYZLut

MAX_WAIT_S = 300
NAMESPACE = "ip link set lo up && ip route add 255.255.255.255 dev lo && exec \"$0\" \"$@\""
ROOM = (-10.0, 10.0), (-8.0, 8.0), (-3.0, 3.0)
EYE = (1.0003, 2.0004, 0.0002)  # the walls are not at whole millimetres


def enter_namespace():
    """Runs this test again in its own namespace; exits."""
    command = ["unshare", "-rn", "sh", "-c", NAMESPACE]
    if shutil.which("ip") is None or subprocess.run([*command, "true"], capture_output=True, check=False).returncode != 0:
        skip("no network namespaces for this user", "run it as root, or install iproute2")
    os.execvp(command[0], [*command, sys.executable, "-B", *sys.argv, "--inside"])


class Stream:
    """glidar stream of a sensor in a room, in real time."""

    def __init__(self, sensor, *options):
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen(
            ["glidar", "stream", "builtin:box:size=20,16,6", "--eye", ",".join(map(str, EYE)), "--sensor", sensor,
             "--ground-truth", *options], stdout=self.log, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(MAX_WAIT_S)
        self.log.seek(0)
        print(self.log.read().decode())
        self.log.close()

    def wait_for_port(self, address, port):
        """Until the sensor accepts connections."""
        while self.process.poll() is None:
            try:
                return socket.create_connection((address, port), MAX_WAIT_S)
            except ConnectionRefusedError:
                continue
        raise AssertionError("glidar has ended")


def wall_errors(points):
    """Distances of points, in metres from the sensor, to the nearest wall of the room."""
    distances = []
    for axis in range(3):
        for wall in ROOM[axis]:
            distances.append(np.abs(points[:, axis] + EYE[axis] - wall))
    return np.min(distances, axis=0)


class Ouster(unittest.TestCase):
    def test_ouster_sdk_starts_from_the_address_alone(self):
        with Stream("OS1-32", "--udp", "127.0.0.1") as stream:
            stream.wait_for_port("127.0.0.1", 80).close()
            source = open_source("127.0.0.1", timeout=60.0)
            lut = None
            scans = []
            for scan_set in source:
                scan = scan_set[0] if not hasattr(scan_set, "h") else scan_set
                lut = lut or XYZLut(scan.sensor_info)
                if scan.complete():
                    scans.append(lut(scan.field("RANGE"))[scan.field("RANGE") > 0])
                if len(scans) == 3:
                    break
            source.close()
        for points in scans:
            self.assertGreater(len(points), 30_000)
            error = wall_errors(points).max()
            print(f"ouster-sdk: {len(points)} points, at most {error * 1e3:.2f} mm from the walls")
            self.assertLess(error, 0.001)

    def test_requests_from_other_addresses_direct_packets_to_them(self):
        with Stream("OS1-32", "--udp", "127.0.0.1", "--control", "127.0.0.7:8080") as stream:
            stream.wait_for_port("127.0.0.7", 8080).close()
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
                receiver.settimeout(MAX_WAIT_S)
                receiver.bind(("127.0.0.1", 0))
                body = json.dumps({"udp_dest": "@auto", "udp_port_lidar": receiver.getsockname()[1]}).encode()
                request = urllib.request.Request("http://127.0.0.7:8080/api/v1/sensor/config", body, method="POST")
                with urllib.request.urlopen(request, timeout=MAX_WAIT_S) as reply:
                    self.assertEqual(reply.status, 200)
                self.assertEqual(len(receiver.recv(65536)), 6400)


class Hesai(unittest.TestCase):
    def test_hydra4_reads_packets_with_the_angles_of_ptc(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
            receiver.settimeout(MAX_WAIT_S)
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
            receiver.bind(("127.0.0.1", 2368))
            with Stream("XT32", "--udp", "127.0.0.1") as stream:
                with stream.wait_for_port("127.0.0.1", 9347) as ptc:
                    ptc.sendall(b"\x47\x74\x05\0\0\0\0\0")
                    with ptc.makefile("rb") as answer:
                        head = answer.read(8)
                        self.assertEqual(head[:4], b"\x47\x74\x05\0")
                        text = answer.read(struct.unpack(">I", head[4:])[0]).decode()
                packets = [receiver.recv(65536) for _ in range(300)]
        self.assertEqual(len(list(csv.DictReader(io.StringIO(text)))), 32)
        with tempfile.TemporaryDirectory() as folder:
            angles = Path(folder) / "angles.csv"
            angles.write_text(text, encoding="ascii")
            decoder = PandarXT32(angles, 0.0, 200.0)
            blocks = [block for data in packets for block in decoder(
                pandar_msgs__msg__PandarPacket(None, np.frombuffer(data, np.uint8), len(data)))]
        points = np.array([point[:3] for block in blocks for point in block.points])
        points = np.column_stack([points[:, 1], -points[:, 0], points[:, 2]])  # its 0 degrees are along y
        # it does not turn the head between a block's azimuth and a firing: up to 0.17 degrees
        error = wall_errors(points)
        print(f"hydra4: {len(points)} points, at most {error.max() * 1e3:.1f} mm from the walls")
        self.assertGreater(len(points), 70_000)
        self.assertLess((error - 0.003 - np.radians(0.19) * np.linalg.norm(points, axis=1)).max(), 0.0)


class EthernetPacket(ctypes.LittleEndianStructure):
    """LivoxLidarEthernetPacket."""

    _pack_ = 1
    _fields_ = [("version", ctypes.c_uint8), ("length", ctypes.c_uint16), ("interval", ctypes.c_uint16),
                ("dots", ctypes.c_uint16), ("count", ctypes.c_uint16), ("frame", ctypes.c_uint8),
                ("type", ctypes.c_uint8), ("time_type", ctypes.c_uint8), ("rest", ctypes.c_uint8 * 12),
                ("crc", ctypes.c_uint32), ("stamp", ctypes.c_uint64), ("data", ctypes.c_uint8 * 1344)]


class Livox(unittest.TestCase):
    HOST = {"cmd_data_port": 56101, "push_msg_port": 56201, "point_data_port": 56301, "imu_data_port": 56401,
            "log_data_port": 56501, "host_ip": "127.0.0.1", "multicast_ip": "", "lidar_ip": ["127.0.0.2"]}
    LIDAR = {"cmd_data_port": 56100, "push_msg_port": 56200, "point_data_port": 56300, "imu_data_port": 56400,
             "log_data_port": 56500}

    def test_livox_sdk_finds_the_sensor_and_receives_points_and_imu(self):
        library = next(Path(livox_sdk.__file__).parent.glob("lib/liblivox_lidar_sdk_shared.so"))
        sdk = ctypes.CDLL(str(library))
        callback = ctypes.CFUNCTYPE(None, ctypes.c_uint32, ctypes.c_uint8, ctypes.POINTER(EthernetPacket), ctypes.c_void_p)
        found = ctypes.CFUNCTYPE(None, ctypes.c_uint32, ctypes.c_void_p, ctypes.c_void_p)
        packets, samples, sensors, done = [], [], [], threading.Event()

        def on_points(_handle, device, packet, _data):
            data = ctypes.string_at(packet, packet.contents.length)
            packets.append((device, data))
            if len(packets) >= 400 and len(samples) >= 20:
                done.set()

        def on_imu(_handle, _device, packet, _data):
            samples.append(ctypes.string_at(packet, packet.contents.length))

        def on_sensor(handle, info, _data):
            sensors.append((handle, ctypes.string_at(info, 33)))  # LivoxLidarInfo: type, sn[16], lidar_ip[16]

        kept = [callback(on_points), callback(on_imu), found(on_sensor)]
        sdk.SetLivoxLidarPointCloudCallBack(kept[0], None)
        sdk.SetLivoxLidarImuDataCallback(kept[1], None)
        sdk.SetLivoxLidarInfoChangeCallback(kept[2], None)
        with tempfile.TemporaryDirectory() as folder:
            config = Path(folder) / "config.json"
            config.write_text(json.dumps({"master_sdk": True, "lidar_log_enable": False, "lidar_log_cache_size_MB": 0,
                                          "lidar_log_path": folder,
                                          "MID360": {"lidar_net_info": self.LIDAR, "host_net_info": [self.HOST]}}))
            # packets go elsewhere until the SDK asks for them
            with Stream("Livox-Avia", "--imu", "BMI088", "--udp", "127.0.0.1:9:9"):
                self.assertTrue(sdk.LivoxLidarSdkInit(str(config).encode(), b"", None))
                finished = done.wait(MAX_WAIT_S)
                sdk.LivoxLidarSdkUninit()
        self.assertTrue(finished)
        ((handle, info),) = sensors
        self.assertEqual(handle, int.from_bytes(socket.inet_aton("127.0.0.2"), "little"))
        serial, address = (text.split(b"\0")[0] for text in (info[1:], info[17:]))  # as C programs print them
        self.assertEqual((info[0], serial, address), (9, b"GLIDAR000000001", b"127.0.0.2"))
        self.assertEqual({device for device, _ in packets}, {9})
        kind = np.dtype([("xyz", "<i4", 3), ("reflectivity", "u1"), ("tag", "u1")])
        points = np.concatenate([np.frombuffer(data[36:], kind)["xyz"] for _, data in packets]) * 1e-3
        points = points[np.any(points != 0, axis=1)]
        error = wall_errors(points)
        print(f"Livox SDK 2: {len(packets)} packets, {len(points)} points, at most {error.max() * 1e3:.2f} mm from the walls, "
              f"{len(samples)} samples of the IMU")
        self.assertLess(error.max(), 0.00051)
        for sample in samples:
            self.assertAlmostEqual(np.linalg.norm(struct.unpack("<3f", sample[48:60])), 1.0, delta=0.2)


if __name__ == "__main__":
    if "--inside" not in sys.argv:
        enter_namespace()
    sys.argv.remove("--inside")
    unittest.main(verbosity=2)
