#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Dates in every output that has them: packets of Velodyne, Ouster, Hesai and Livox, bags of ROS 2, MCAP, OSI and the
live view. Independent readers find the times that follow from the date of the trajectory and from the periods of the sensor.
The built program is found in PATH. DDS has its own test: tests/link/dds/cyclonedds_test.py."""

import calendar
import json
import re
import struct
import subprocess
import unittest
from fractions import Fraction
from pathlib import Path

from cli_support import CliTest, free_ports
from skipping import importing
from waiting import MAX_WAIT_S, wait_for_line

with importing():
    import numpy as np
    from cloud_message import points_of
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory
    from osi3trace.osi_trace import OSITrace
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore
    from websockets.sync.client import connect

SECOND = 10**9
FRAME = SECOND // 10
RECORDED = 1_700_000_000_123_456_789  # the time of the first pose; no double holds it
HOUR = 3600 * SECOND
ROOM = ("builtin:box:size=20,16,6", "--ground-truth", "--trajectory", "drive.tum")  # every beam returns


# The times of an OS1-32 at 10 Hz with 1024 columns, and of an IMU with 200 Hz.

def frame_times(count):
    return [RECORDED + k * FRAME for k in range(count)]


def column_times(frame_ns):
    return frame_ns + np.round(np.arange(1024) * FRAME / 1024).astype(np.int64)


def sample_times(count):
    return [RECORDED + k * SECOND // 200 for k in range(count)]


# Readers. Each returns what it finds, in nanoseconds since 1970: the stamps of frames, those of all points of a frame, those of
# the samples of an IMU, and when clouds were received.

def point_times(cloud, stamp_ns):
    """The times of the columns: the nanoseconds `t` of Ouster's driver after the stamp of the message."""
    return np.unique(stamp_ns + points_of(cloud)["t"].astype(np.int64))


def of_messages(messages):
    """From (topic, message, nanoseconds when it was received) in any order of topics."""
    found = {"frames": [], "points": [], "samples": [], "received": [], "samples received": []}
    for topic, message, received_ns in messages:
        if topic not in ("/lidar/points", "/imu/data"):
            continue
        stamp_ns = message.header.stamp.sec * SECOND + message.header.stamp.nanosec
        found["frames" if topic == "/lidar/points" else "samples"].append(stamp_ns)
        found["received" if topic == "/lidar/points" else "samples received"].append(received_ns)
        if topic == "/lidar/points":
            found["points"].append(point_times(message, stamp_ns))
    return found


def read_by_rosbags(path):
    with AnyReader([path]) as reader:
        return of_messages((connection.topic, reader.deserialize(data, connection.msgtype), time_ns)
                           for connection, time_ns, data in reader.messages())


def read_by_mcap(path):
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return of_messages((channel.topic, message, record.log_time)
                           for _, channel, record, message in reader.iter_decoded_messages())


def read_by_osi(path):
    trace = OSITrace(str(path), "SensorData")
    stamps = [message.timestamp.seconds * SECOND + message.timestamp.nanos for message in trace]
    trace.close()
    return {"frames": stamps}


def datagrams(path):
    """(nanoseconds when it was captured, payload) of the datagrams of a pcap file with microseconds, IPv4 and UDP. Fragments
    of a datagram follow each other."""
    data = Path(path).read_bytes()
    assert struct.unpack_from("<I", data) == (0xA1B2C3D4,)
    link_bytes = {1: 14, 101: 0}[struct.unpack_from("<I", data, 20)[0]]
    at, found = 24, []
    while at < len(data):
        seconds, microseconds, size, _ = struct.unpack_from("<IIII", data, at)
        packet = data[at + 16 + link_bytes:at + 16 + size]
        part, is_first = packet[4 * (packet[0] & 15):], struct.unpack_from(">H", packet, 6)[0] & 0x1FFF == 0
        before = b"" if is_first else found.pop()[1]
        found.append((seconds * SECOND + microseconds * 1000, before + part[8 if is_first else 0:]))
        at += 16 + size
    return found


def read_ouster_packets(path):
    """RNG19_RFL8_SIG16_NIR16: 32 bytes, 16 columns of 12 + 32 x 12 bytes, 32 bytes; IMU: three times at the start."""
    columns, samples = [], []
    for _, payload in datagrams(path):
        if len(payload) == 6400:
            columns += [struct.unpack_from("<Q", payload, 32 + k * 396)[0] for k in range(16)]
        elif len(payload) == 48:
            samples.append(struct.unpack_from("<3Q", payload))
    columns = np.array(columns, np.int64)
    return {"points": list(columns.reshape(-1, 1024)), "frames": columns[::1024].tolist(),
            "samples": [acceleration for _, acceleration, _ in samples]}


# Packets: bytes of a data packet; its time; packets after which the times repeat, in nanoseconds; the time of the first packet
# after its first firing.

def velodyne_time(payload):
    """Microseconds after the full hour: VLP-16 manual 63-9243, 9.3.1."""
    return RECORDED // HOUR * HOUR + struct.unpack_from("<I", payload, 1200)[0] * 1000


def hesai_time(payload, date_at, microseconds_at, first_year):
    """A date in UTC and microseconds, at these places: tier4/nebula, hesai_packet.hpp, pandar_64.hpp, pandar_qt64.hpp,
    pandar_xt32.hpp."""
    year, *rest = payload[date_at:date_at + 6]
    seconds = calendar.timegm((first_year + year, *rest))
    return seconds * SECOND + struct.unpack_from("<I", payload, microseconds_at)[0] * 1000


def livox_time(payload):
    """LivoxLidarEthernetPacket of Livox SDK 2: nanoseconds of the first point."""
    return struct.unpack_from("<Q", payload, 28)[0]


DATA_PACKETS = {
    # a packet has 24 firings of 55.296 us
    "VLP-16": (1206, velodyne_time, 24 * 55_296, 0, 1000),
    # 8 blocks of 50 us; the time is that of the last block
    "XT32": (1080, lambda p: hesai_time(p, 1052 + 13, 1052 + 19, 1900), 400_000, 350_000, 1000),
    # 6 blocks of 55.56 us; the time is 42.58 us after the start of the last one. Lasers fire before their block, so that the
    # first whole block is the second of the run
    "Pandar64": (1198, lambda p: hesai_time(p, 1172 + 16, 1172 + 10, 2000), 333_333, 333_333 + 42_580, 1500),
    # 4 blocks of 166.67 us; the time is 35.71 us before the start of the first one
    "QT64": (1072, lambda p: hesai_time(p, 1044 + 18, 1044 + 12, 1900), 666_667, -35_710, 1500),
    # 24 pulses of 4 points every 20 us, the first one after half of that
    "Livox-Mid-360": (1380, livox_time, 480_000, 10_000, 1),
}


class Stamps(CliTest):
    def setUp(self):
        super().setUp()
        self.write("drive.tum", "".join(f"{t // SECOND}.{t % SECOND:09} {k} 0 0 0 0 0 1\n" for k, t in
                                        enumerate((RECORDED, RECORDED + SECOND))))

    def path(self, name):
        return Path(self.folder, name)

    READERS = {"run.rosbag2": read_by_rosbags, "run.mcap": read_by_mcap, "run.osi": read_by_osi,
               "run.pcap": read_ouster_packets}

    def check(self, found, frames, samples):
        """All that a reader found, against the times of an OS1-32 and an IMU."""
        self.assertEqual(found["frames"], frame_times(frames))
        if "points" in found:
            for times, frame_ns in zip(found["points"], frame_times(frames), strict=True):
                self.assertLessEqual(np.abs(times - column_times(frame_ns)).max(), 1)
        if "samples" in found:
            self.assertEqual(found["samples"], sample_times(samples))
        if "received" in found:  # a cloud when its last column is measured, a sample at once
            last = [int(times[-1]) for times in found["points"]]
            for received_ns, last_ns in zip(found["received"], last, strict=True):
                self.assertTrue(last_ns <= received_ns <= last_ns + 100_000, received_ns - last_ns)
            self.assertEqual(found["samples received"], found["samples"])

    def test_files_of_a_run_have_the_same_dates(self):
        outputs = [part for name in self.READERS for part in ("-o", name)]
        self.succeed("render", *ROOM, "--sensor", "OS1-32", "--imu", "BMI088", "--duration", "0.2", "--layout", "ouster",
                     *outputs)
        for name, read in self.READERS.items():
            with self.subTest(name):
                found = read(self.path(name))
                samples = len(found.get("samples", ()))
                self.check(found, 2, samples)
                self.assertIn(samples, (0,) if "samples" not in found else (40, 41))
        captured = [time_ns for time_ns, payload in datagrams(self.path("run.pcap")) if len(payload) == 6400]
        sent = [RECORDED + (16 * k + 15) * FRAME // 1024 for k in range(128)]  # with its last column
        self.assertLess(max(abs(a - b) for a, b in zip(captured, sent, strict=True)), 200_000)

    def test_data_packets_of_every_maker_have_dates(self):
        for sensor, (size, time_of, period_ns, offset_ns, tolerance_ns) in DATA_PACKETS.items():
            with self.subTest(sensor):
                self.succeed("render", *ROOM, "--sensor", sensor, "--duration", "0.2", "-o", "run.pcap")
                packets = [(time_ns, payload) for time_ns, payload in datagrams(self.path("run.pcap")) if len(payload) == size]
                self.assertGreater(len(packets), 100)
                for k, (captured_ns, payload) in enumerate(packets):
                    first_ns = RECORDED + k * period_ns
                    self.assertLessEqual(abs(time_of(payload) - first_ns - offset_ns), tolerance_ns, k)
                    self.assertTrue(0 <= captured_ns - first_ns <= period_ns + 100_000, captured_ns - first_ns)

    def test_clouds_of_the_driver_of_hesai_have_the_times_of_packets(self):
        for sensor in ("XT32", "Pandar64", "QT64"):
            with self.subTest(sensor):
                size, time_of, *_ = DATA_PACKETS[sensor]
                self.succeed("render", *ROOM, "--sensor", sensor, "--duration", "0.1", "--as", "hesai", "-o", "a.rosbag2",
                             "-o", "run.pcap")
                with AnyReader([self.path("a.rosbag2")]) as reader:
                    (cloud,) = [reader.deserialize(data, connection.msgtype)
                                for connection, _, data in reader.messages() if connection.topic == "/lidar_points"]
                packets = [time_of(payload) for _, payload in datagrams(self.path("run.pcap")) if len(payload) == size]
                self.assertEqual(cloud.header.stamp.sec * SECOND + cloud.header.stamp.nanosec, packets[0])
                kind = np.dtype({"names": ["t"], "formats": ["<f8"], "offsets": [18], "itemsize": cloud.point_step})
                stamps = np.unique(np.frombuffer(bytes(cloud.data), kind)["t"])
                self.assertLess(np.abs(stamps - np.array(packets) / 1e9).max(), 1e-6)

    def test_position_packets_of_velodyne_have_the_date_in_text(self):
        self.succeed("render", *ROOM, "--sensor", "VLP-16", "--duration", "0.2", "-o", "run.pcap")
        texts = [payload[206:].split(b"\r\n")[0].decode() for _, payload in datagrams(self.path("run.pcap"))
                 if len(payload) == 512]
        self.assertTrue(texts)
        for text in texts:  # 14 November 2023, 22:13:20
            self.assertRegex(text, r"^\$GPRMC,221320,V,.*,141123,")

    def test_absolute_times_of_points_are_dates(self):
        cases = (("OS1-32", "hesai", "/lidar/points", SECOND, 360), ("OS1-32", "livox", "/lidar/points", 1, 130))
        for sensor, layout, topic, unit_ns, limit_ns in cases:  # doubles have steps of 238 ns and 256 ns at this date
            with self.subTest(layout):
                self.succeed("render", *ROOM, "--sensor", sensor, "--duration", "0.1", "--layout", layout, "-o", "a.rosbag2")
                with AnyReader([self.path("a.rosbag2")]) as reader:
                    (cloud,) = [reader.deserialize(data, connection.msgtype)
                                for connection, _, data in reader.messages() if connection.topic == topic]
                kind = np.dtype({"names": ["t"], "formats": ["<f8"], "itemsize": cloud.point_step,
                                 "offsets": [next(f.offset for f in cloud.fields if f.name == "timestamp")]})
                stamps = np.unique(np.frombuffer(bytes(cloud.data), kind)["t"])
                wanted = column_times(RECORDED)
                errors = [abs(Fraction(float(a)) * unit_ns - int(b)) for a, b in zip(stamps, wanted, strict=True)]
                self.assertLessEqual(max(errors), limit_ns)
        self.succeed("render", *ROOM, "--sensor", "Livox-Mid-360", "--duration", "0.1", "--as", "livox", "-o", "b.rosbag2")
        with AnyReader([self.path("b.rosbag2")]) as reader:
            (message,) = [reader.deserialize(data, connection.msgtype)
                          for connection, _, data in reader.messages() if connection.topic == "/livox/lidar"]
        self.assertEqual(message.timebase, RECORDED + 10_000)
        self.assertEqual(message.header.stamp.sec * SECOND + message.header.stamp.nanosec, message.timebase)
        self.assertEqual([point.offset_time for point in message.points], [20_000 * (k // 4) for k in range(20_000)])

    def test_the_live_view_has_the_dates_of_messages(self):
        port = free_ports()
        program = subprocess.Popen(
            ["glidar", "stream", *ROOM, "--sensor", "OS1-32", "--imu", "BMI088", "--layout", "ouster", "--rate", "10",
             "--foxglove", str(port)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            wait_for_line(program.stdout, re.compile("live view"))
            found = self.subscribed(port)
        finally:
            program.kill()
            program.communicate()
        self.assertGreater(len(found["frames"]), 1)
        for stamp_ns, time_ns, points in zip(found["frames"], found["received"], found["points"], strict=True):
            self.assertEqual((stamp_ns - RECORDED) % FRAME, 0)
            self.assertTrue(RECORDED <= stamp_ns <= time_ns <= stamp_ns + FRAME)
            self.assertLessEqual(np.abs(points - column_times(stamp_ns)).max(), 1)
        for stamp_ns, time_ns in zip(found["samples"], found["samples received"], strict=True):
            self.assertEqual((stamp_ns - RECORDED) % (SECOND // 200), 0)
            self.assertEqual(time_ns, stamp_ns)

    def subscribed(self, port):
        """Messages of the Foxglove WebSocket protocol: byte 1, number of the subscription, nanoseconds, CDR."""
        store, messages, kinds = get_typestore(Stores.ROS2_HUMBLE), [], {}
        with connect(f"ws://127.0.0.1:{port}/", subprotocols=["foxglove.websocket.v1"], max_size=None,
                     open_timeout=MAX_WAIT_S) as client:
            while sum(topic == "/lidar/points" for topic, _, _ in messages) < 2 or len(messages) < 10:
                data = client.recv(MAX_WAIT_S)
                if isinstance(data, str):
                    channels = [c for c in json.loads(data).get("channels", ()) if c["topic"] in ("/lidar/points", "/imu/data")]
                    kinds |= {c["id"]: (c["topic"], c["schemaName"]) for c in channels}
                    subscriptions = [{"id": c["id"], "channelId": c["id"]} for c in channels]
                    client.send(json.dumps({"op": "subscribe", "subscriptions": subscriptions}))
                elif data[0] == 1:
                    number, time_ns = struct.unpack_from("<IQ", data, 1)
                    topic, kind = kinds[number]
                    messages.append((topic, store.deserialize_cdr(data[13:], kind), time_ns))
        return of_messages(messages)


if __name__ == "__main__":
    unittest.main()
