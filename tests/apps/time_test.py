# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Stamps of all outputs of a run, with and without a trajectory that has dates. The built program is found in PATH."""

import csv
import json
import struct
import time
import unittest
from pathlib import Path

from cli_support import CliTest

SECOND = 10**9
RECORDED = 1_700_000_000_123_456_789  # no double holds it
DEFAULT_DATE = 1_767_225_600 * SECOND
ROOM = ("render", "builtin:box:size=20,16,6", "--sensor", "VLP-16", "--ground-truth")
STAMPS = ("--columns", "xyz,stamp,time,sensor_pose")


def drive(first_ns, seconds=4):
    """Along x by 1 m/s, in TUM's format."""
    rows = ((first_ns + k * SECOND, k) for k in range(seconds + 1))
    return "".join(f"{t // SECOND}.{t % SECOND:09} {x} 0 0 0 0 0 1\n" for t, x in rows)


class Times(CliTest):
    def rows(self, name):
        with open(Path(self.folder, name), encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def first(self, name):
        """Stamp and x of the sensor of the first beam, and the stamp of its frame."""
        row = min(self.rows(name), key=lambda row: int(row["stamp"]))
        frame_ns = json.loads(Path(self.folder, name.partition(".")[0] + ".glidar.json").read_text())["stamp_ns"]
        self.assertEqual(int(row["stamp"]), frame_ns + int(row["time"]))
        return int(row["stamp"]) - int(row["time"]), float(row["sensor_pose_x"]), frame_ns

    def test_all_files_have_the_time_of_a_trajectory_with_dates(self):
        self.write("drive.tum", drive(RECORDED))
        outputs = ("f.csv", "f.las", "f.ply", "d.kitti", "i.imu.csv", "p.pcap", "b.mcap")
        arguments = (*ROOM, "--trajectory", "drive.tum", "--imu", "BMI088", "--duration", "0.2", "--per-frame", *STAMPS)
        for folder in ("one", "two"):
            Path(self.folder, folder).mkdir()
            self.succeed(*arguments, *(part for name in outputs for part in ("-o", f"{folder}/{name}")))
        for frame in range(2):
            stamp_ns, x, frame_ns = self.first(f"one/f_00000{frame}.csv")
            self.assertEqual(frame_ns, RECORDED + frame * SECOND // 10)
            self.assertEqual(stamp_ns, frame_ns)
            self.assertAlmostEqual(x, 0.1 * frame, delta=0.002)
        first = min(int(row["stamp"]) for row in self.rows("one/f_000000.csv"))
        self.assertAlmostEqual(self.las_gps_time("one/f_000000.las"),
                               (first - RECORDED) / 1e9 + 1_700_000_000.123456789 + 18 - 315_964_800 - 10**9, delta=5e-7)
        self.assertEqual(self.ply_stamp("one/f_000000.ply"), first)
        self.assertEqual(Path(self.folder, "one/d.kitti/times.txt").read_text(),
                         "1700000000.123456789\n1700000000.223456789\n")
        samples = [int(row["t_ns"]) for row in self.rows("one/i.imu.csv")]
        self.assertEqual(samples[0], RECORDED)
        self.assertLessEqual(abs(samples[-1] - RECORDED - SECOND // 5), SECOND // 400)
        data_ns = self.capture_times("one/p.pcap")[0]
        self.assertLess(abs(data_ns - RECORDED - 1_330_000), 50_000)  # 24 sequences of 55.296 us, then sent
        for path in Path(self.folder, "one").rglob("*"):
            if path.is_file() and not path.name.endswith(".json"):  # these have the command
                other = Path(self.folder, "two", path.relative_to(Path(self.folder, "one")))
                self.assertEqual(path.read_bytes(), other.read_bytes(), path.name)

    def las_gps_time(self, name):
        data = Path(self.folder, name).read_bytes()
        self.assertTrue(data[6] & 1)  # adjusted standard GPS time
        start, = struct.unpack_from("<I", data, 96)
        size, = struct.unpack_from("<H", data, 105)
        count, = struct.unpack_from("<Q", data, 247)
        return min(struct.unpack_from("<d", data, start + k * size + 22)[0] for k in range(count))

    def ply_stamp(self, name):
        data = Path(self.folder, name).read_bytes()
        header, body = data.split(b"end_header\n", 1)
        fields = [line.split()[1:] for line in header.decode().splitlines() if line.startswith("property")]
        codes = {"float": "f", "double": "d", "uint": "I", "ushort": "H", "uchar": "B"}
        row = struct.Struct("<" + "".join(codes[kind] for kind, _ in fields))
        names = [name for _, name in fields]
        first, second = names.index("stamp_sec"), names.index("stamp_nsec")
        return min(one[first] * SECOND + one[second] for one in row.iter_unpack(body))

    def capture_times(self, name):
        """Times of the packets of a pcap file with microseconds."""
        data = Path(self.folder, name).read_bytes()
        self.assertEqual(struct.unpack_from("<I", data), (0xA1B2C3D4,))
        times, at = [], 24
        while at < len(data):
            seconds, microseconds, size = struct.unpack_from("<III", data, at)
            times.append(seconds * SECOND + microseconds * 1000)
            at += 16 + size
        return times

    def test_files_start_at_0_and_bags_and_packets_at_a_date(self):
        self.succeed(*ROOM, *STAMPS, "-o", "a.csv")
        self.assertEqual(self.first("a.csv")[2], 0)
        for other in ("b.mcap", "b.rosbag2", "b.pcap"):
            self.succeed(*ROOM, *STAMPS, "-o", "a.csv", "-o", other)
            self.assertEqual(self.first("a.csv")[2], DEFAULT_DATE, other)
        self.assertLess(abs(self.capture_times("b.pcap")[0] - DEFAULT_DATE), SECOND // 100)

    def test_times_that_are_no_dates_count_from_that_date(self):
        self.write("drive.tum", drive(5 * SECOND))
        self.succeed(*ROOM, *STAMPS, "--trajectory", "drive.tum", "-o", "a.csv")
        self.assertEqual(self.first("a.csv")[2], 5 * SECOND)
        self.succeed(*ROOM, *STAMPS, "--trajectory", "drive.tum", "-o", "a.csv", "-o", "b.mcap")
        self.assertEqual(self.first("a.csv")[2], DEFAULT_DATE + 5 * SECOND)

    def test_a_start_time_is_exact_in_seconds_and_as_a_date(self):
        for text in ("1700000000.123456789", "1.700000000123456789e9", "2023-11-14T22:13:20.123456789Z"):
            self.succeed(*ROOM, *STAMPS, "--start-time", text, "-o", "a.csv")
            self.assertEqual(self.first("a.csv")[2], RECORDED)
        self.write("drive.tum", drive(5 * SECOND))
        self.succeed(*ROOM, *STAMPS, "--trajectory", "drive.tum", "--start-time", "1700000000.123456789", "-o", "a.csv")
        stamp_ns, x, _ = self.first("a.csv")
        self.assertEqual(stamp_ns, RECORDED)
        self.assertLess(x, 0.002)

    def test_a_segment_has_its_poses_and_times(self):
        self.write("drive.tum", drive(RECORDED))
        for start in (("--from", "1700000001.123456789"), ("--from", "+1"), ("--start-time", "1700000001.123456789")):
            self.succeed(*ROOM, *STAMPS, "--trajectory", "drive.tum", *start, "--to", "+1.3", "--per-frame", "-o", "a.csv")
            self.assertEqual([name for name in self.files() if name.endswith(".csv")],
                             [f"a_00000{k}.csv" for k in range(3)])
            stamp_ns, x, _ = self.first("a_000000.csv")
            self.assertEqual(stamp_ns, RECORDED + SECOND)
            self.assertAlmostEqual(x, 1.0, delta=0.002)
        self.succeed(*ROOM, *STAMPS, "--trajectory", "drive.tum", "--from", "+1", "--start-time", "7", "-o", "b.csv")
        stamp_ns, x, _ = self.first("b.csv")
        self.assertEqual(stamp_ns, 7 * SECOND)
        self.assertAlmostEqual(x, 1.0, delta=0.002)

    def test_now_is_the_time_of_the_clock_and_is_kept_in_the_command(self):
        self.write("drive.tum", drive(RECORDED))
        before = time.time_ns()
        self.succeed(*ROOM, *STAMPS, "--trajectory", "drive.tum", "--start-time", "now", "-o", "a.csv")
        stamp_ns, x, _ = self.first("a.csv")
        self.assertTrue(before <= stamp_ns <= time.time_ns())
        self.assertLess(x, 0.002)
        self.assertIn(f"start of frame 0 at {stamp_ns} ns", self.succeed("explain", "a.csv", "--index", "5").stdout)

    def test_a_frame_beside_a_bag_is_explained_at_its_date(self):
        self.succeed(*ROOM, "-o", "a.pcd", "-o", "b.mcap")
        self.assertIn(f"start of frame 0 at {DEFAULT_DATE} ns", self.succeed("explain", "a.pcd", "--index", "5").stdout)

    def test_objects_share_the_clock_of_the_sensor(self):
        self.write("drive.tum", drive(RECORDED))
        self.write("car.tum", drive(RECORDED + SECOND))
        scene = ("models: [{model: 'builtin:box:size=20,16,6'}, {model: builtin:box, motion: {trajectory: car.tum}}]\n"
                 "sensor: VLP-16\n")
        self.write("scene.yaml", scene + "sensor_motion: {trajectory: drive.tum}\n")
        self.write("still.yaml", scene + "sensor_pose: {position: [0, 5, 0]}\n")
        boxes = ("--ground-truth", "--columns", "xyz,stamp,object_pose,instance")

        def car(*arguments):
            self.succeed("render", *arguments, *boxes, "-o", "a.csv")
            rows = [row for row in self.rows("a.csv") if row["instance"] == "2"]
            return int(rows[0]["stamp"]), float(rows[0]["object_pose_x"])

        stamp_ns, x = car("scene.yaml", "--from", "+3")
        self.assertAlmostEqual(x, (stamp_ns - RECORDED - SECOND) / 1e9, delta=1e-9)
        self.assertAlmostEqual(x, 2.05, delta=0.06)
        stamp_ns, x = car("still.yaml")
        self.assertAlmostEqual(x, (stamp_ns - RECORDED - SECOND) / 1e9, delta=1e-9)
        stamp_ns, x = car("still.yaml", "--start-time", "1700000003.123456789")
        self.assertAlmostEqual(x, 2.05, delta=0.06)

    def test_a_recorded_stream_repeats_with_its_times(self):
        self.write("drive.tum", drive(RECORDED))
        common = ("builtin:box:size=20,16,6", "--sensor", "VLP-16", "--trajectory", "drive.tum", "--rate", "max")
        for start, wanted in ((), RECORDED), (("--start-time", "now"), None):
            self.succeed("stream", *common, *start, "--frames", "2", "--record", "r.jsonl", "-o", "a.csv", *STAMPS)
            if wanted:
                self.assertEqual(self.first("a_000000.csv")[2], wanted)
            first = self.rows("a_000001.csv")
            self.succeed("replay", "r.jsonl", "-o", "c.csv", "-o", "c.mcap", *STAMPS)
            self.assertEqual(self.rows("c_000001.csv"), first)

    def test_errors_state_the_times_of_the_trajectory(self):
        self.write("drive.tum", drive(RECORDED))
        run = (*ROOM, "--trajectory", "drive.tum", "-o", "a.csv")
        self.assertIn("--start-time, start time: 1700000005 s, outside of the trajectory of the sensor; allowed: "
                      "1700000000.123456789 to 1700000004.123456789 s", self.refused(*run, "--start-time", "1700000005"))
        self.assertIn("--from, start on the trajectory: 3 s, outside", self.refused(*run, "--from", "3"))
        self.assertIn("--to: 1700000000.123456789 s; allowed: after 1700000000.123456789 s",
                      self.refused(*run, "--to", "+0"))
        self.assertIn("--to", self.refused(*run, "--to", "+1", "--duration", "1"))
        self.assertIn("--from, start on the trajectory: the sensor has none",
                      self.refused(*ROOM, "--eye", "0,0,0", "--from", "3", "-o", "a.csv"))
        self.assertIn("--to: the sensor has no trajectory", self.refused(*ROOM, "--eye", "0,0,0", "--to", "3", "-o", "a.csv"))
        for text in ("soon", "-1", "2026-01-01", "nowhere", "1e30"):
            self.assertIn("seconds since 1970, a date in UTC, now or trajectory",
                          self.refused(*ROOM, f"--start-time={text}", "-o", "a.csv"))
        self.assertIn("--pose-source and --start-time", self.refused(
            "stream", "builtin:box", "--port", "5555", "--pose-source", "tcp://127.0.0.1:5557", "--start-time", "now"))


if __name__ == "__main__":
    unittest.main()
