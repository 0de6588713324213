#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""glidar decode: clouds of packet captures and bags. The built program is found in PATH."""

import json
import os
import struct
import unittest
import zipfile

import numpy as np
from cli_support import CliTest

ROOM = ("builtin:box:size=20,16,6", "--eye", "1,2,0", "--sensor-rate", "0,0.3,0", "--duration", "0.2", "--ground-truth")


class DecodeTest(CliTest):
    def arrays(self, name):
        with np.load(os.path.join(self.folder, name)) as stored:
            return {key: stored[key] for key in stored.files}


class Cdr:
    """Serializes members of a message of ROS 2."""

    def __init__(self):
        self.data = b""

    def add(self, form, *values):
        size = struct.calcsize("<" + form[0])
        self.data += bytes(-len(self.data) % size) + struct.pack("<" + form, *values)
        return self

    def text(self, text):
        self.add("I", len(text) + 1).data += text + b"\0"
        return self

    def message(self):
        return b"\0\1\0\0" + self.data


def cloud_message(names, frame_id=b"map"):
    """A PointCloud2 of one point with these fields of one byte behind x, y and z; a byte's value is its index."""
    message = Cdr().add("iI", 1, 0).text(frame_id).add("III", 1, 1, 3 + len(names))
    for i, name in enumerate([b"x", b"y", b"z", *names]):
        message.text(name).add("I", 4 * i if i < 3 else 9 + i).add("B", 7 if i < 3 else 2).add("I", 1)
    data = struct.pack("<3f", 1, 2, 3) + bytes(range(len(names)))
    message.add("B", 0).add("II", len(data), len(data)).add("I", len(data)).data += data + b"\1"
    return message.message()


def mcap_of(message, topic=b"/points"):
    """A bag with a message PointCloud2: mcap.dev/spec."""
    def text(value):
        return struct.pack("<I", len(value)) + value

    def record(kind, content):
        return bytes([kind]) + struct.pack("<Q", len(content)) + content

    magic = b"\x89MCAP0\r\n"
    return magic + b"".join([
        record(1, text(b"ros2") + text(b"test")),
        record(3, struct.pack("<H", 1) + text(b"sensor_msgs/msg/PointCloud2") + text(b"ros2msg") + text(b"")),
        record(4, struct.pack("<HH", 1, 1) + text(topic) + text(b"cdr") + struct.pack("<I", 0)),
        record(5, struct.pack("<HIQQ", 1, 0, 0, 0) + message),
        record(15, struct.pack("<I", 0)), record(2, struct.pack("<QQI", 0, 0, 0))]) + magic


class Names(DecodeTest):
    """Names in bags of others."""

    HOSTILE = [b"../../../evil", b"/etc/passwd", b"a\nelement face 99\nproperty list uchar int v", b"=cmd|x,\"", b"=cmd|y,\"",
               b"@SUM(1)", b"-1", b"a,b", b"a\tb", b"\x1b]0;T\x07", b"\xff\xfe", b"\xe2\x80\xaeevil", b"seed", b"stamp_ns",
               b"xyz", b"world_from_sensor", b"normal", b"n" * 4000, b"n" * 4001]

    def decode(self, names, *outputs, frame_id=b"map"):
        with open(os.path.join(self.folder, "in.mcap"), "wb") as file:
            file.write(mcap_of(cloud_message(names, frame_id)))
        self.succeed("decode", "in.mcap", *(word for output in outputs for word in ("-o", output)))

    def test_names_of_fields_have_letters_digits_and_underscores_in_every_output(self):
        self.decode(self.HOSTILE, "o.npz", "o.ply", "o.pcd", "o.csv", frame_id=b"map\nelement face 9\xe2\x80\xa8x")
        with zipfile.ZipFile(os.path.join(self.folder, "o_000000.npz")) as archive:
            members = archive.namelist()
        self.assertEqual(len(members), len(set(members)))
        for member in members:
            self.assertRegex(member, r"\A[A-Za-z0-9_]{1,96}\.npy\Z")
        ply = self.bytes_of("o_000000.ply").split(b"end_header\n")[0].decode().splitlines()
        self.assertEqual([line.split()[0] for line in ply if line.split()[0] == "element"], ["element"])
        fields = [line.split()[-1] for line in ply if line.startswith("property")]
        pcd = self.bytes_of("o_000000.pcd").split(b"DATA")[0].decode().splitlines()
        csv = self.bytes_of("o_000000.csv").decode().splitlines()
        self.assertEqual(len(csv), 2)
        for names in (fields, pcd[3].split()[1:], csv[0].split(",")):
            self.assertEqual(len(names), 3 + len(self.HOSTILE))
            self.assertEqual(len(names), len(set(names)))
            for name in names:
                self.assertRegex(name, r"\A[A-Za-z0-9_]{1,96}\Z")

    def test_names_that_become_the_same_are_numbered_in_their_order(self):
        self.decode([b"a.b", b"a-b", b"a_b", b"seed"], "o.npz")
        found = self.arrays("o_000000.npz")
        self.assertEqual([int(found[name][0, 0]) for name in ("a_b", "a_b_2", "a_b_3", "seed_2")], [0, 1, 2, 3])
        self.assertEqual(found["seed"].shape, ())

    def test_a_field_named_like_a_column_of_three_numbers_has_its_one(self):
        self.decode([b"normal", b"colour"], "o.ply", "o.pcd", "o.csv")
        self.assertEqual(self.bytes_of("o_000000.csv"), b"x,y,z,normal,colour\n1,2,3,0,1\n")
        self.assertIn(b"property uchar normal\n", self.bytes_of("o_000000.ply"))


class Decode(DecodeTest):
    def render(self, sensor, *outputs, options=(), columns="xyz,intensity,range,ring,time"):
        words = [word for output in outputs for word in ("-o", output)]
        self.succeed("render", *ROOM, "--sensor", sensor, "--columns", columns, *options, *words)

    def compare(self, sensor, unit_m, *options, rendering=(), frames=2):
        """Decoded frames against those that were measured, beam by beam; the last packet of a frame may be decoded
        with the next."""
        self.render(sensor, "true.npz", "scan.pcap", options=rendering)
        done = self.succeed("decode", "scan.pcap", *options, "-o", "found.npz")
        self.assertIn(f"{frames} frames", done.stdout)
        self.assertIn("found_000000.npz", done.stdout)
        beams = 0
        for k in range(frames):
            true, found = self.arrays(f"true_00000{k}.npz"), self.arrays(f"found_00000{k}.npz")
            self.assertEqual(found["range"].shape, true["range"].shape)
            valid = np.isfinite(true["range"]) & np.isfinite(found["range"])
            beams += valid.sum()
            self.assertGreater(valid.mean(), 0.95)
            self.assertLessEqual(np.abs(true["range"] - found["range"])[valid].max(), 0.5001 * unit_m)
            self.assertTrue((true["ring"] == found["ring"]).all())
        self.assertGreater(beams, 10000)

    def test_velodyne_packets_are_the_measured_clouds_within_their_unit(self):
        self.compare("VLP-16", 0.002, "--sensor", "VLP-16")

    def test_ouster_packets_need_only_their_metadata(self):
        self.compare("OS1-32", 0.001)

    def test_ouster_packets_have_the_mode_of_the_sensor(self):
        self.compare("OS1-32", 0.001, rendering=("--mode", "512x20"), frames=4)
        with open(os.path.join(self.folder, "scan.json"), encoding="utf-8") as file:
            metadata = json.load(file)
        self.assertEqual(metadata["config_params"]["lidar_mode"], "512x20")
        self.assertEqual(metadata["lidar_data_format"]["columns_per_frame"], 512)
        self.compare("OS1-32", 0.001, "--sensor", "OS1-32", "--mode", "512x20", rendering=("--mode", "512x20"), frames=4)
        self.assertIn("--mode: there is no --sensor", self.refused("decode", "scan.pcap", "--mode", "512x20", "-o", "a.npz"))

    def test_hesai_packets_are_the_measured_clouds_within_their_unit(self):
        self.compare("XT32", 0.004, "--sensor", "XT32")

    def test_livox_packets_are_the_measured_clouds_within_their_unit(self):
        for data_type, unit_m in (("1", 0.001), ("2", 0.01)):
            self.compare("Livox-Avia", 1.7322 * unit_m, "--sensor", "Livox-Avia", rendering=("--livox-data-type", data_type))
            true, found = self.arrays("true_000000.npz"), self.arrays("found_000000.npz")
            self.assertTrue(np.array_equal(true["time"], found["time"]))

    def test_clouds_of_bags_have_the_points_of_the_messages(self):
        self.render("VLP-16", "true.npz", "run.mcap", "run.rosbag2")
        for bag in ("run.mcap", "run.rosbag2"):
            self.succeed("decode", bag, "--topic", "/lidar/points", "-o", "found.npz", "-o", "found.pcd")
            for k in range(2):
                true, found = self.arrays(f"true_00000{k}.npz"), self.arrays(f"found_00000{k}.npz")
                ranges = true["range"][np.isfinite(true["range"])]
                self.assertTrue(np.array_equal(np.sort(found["range"].ravel()), np.sort(ranges.ravel())))
                self.assertTrue((np.diff(found["time"].ravel().astype(np.int64)) >= 0).all())
            os.rename(os.path.join(self.folder, "found_000000.npz"), os.path.join(self.folder, "kept.npz"))

    def test_ends_after_the_given_frames(self):
        self.render("VLP-16", "scan.pcap")
        self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "--frames", "1", "-o", "one.csv")
        self.assertEqual([name for name in self.files() if name.startswith("one")], ["one_000000.csv"])

    def test_errors_state_what_is_missing(self):
        self.render("VLP-16", "scan.pcap", "run.mcap")
        self.assertIn("--sensor VLP-16, for example", self.refused("decode", "scan.pcap", "-o", "a.pcd"))
        self.assertIn("there is no -o", self.refused("decode", "scan.pcap", "--sensor", "VLP-16"))
        self.assertIn("no packet is valid", self.refused("decode", "scan.pcap", "--sensor", "VLP-32C", "-o", "a.pcd"))
        self.assertIn("manufacturer", self.refused("decode", "scan.pcap", "--sensor", "D435", "-o", "a.pcd"))
        self.assertIn("/lidar/points", self.refused("decode", "run.mcap", "--topic", "/other", "-o", "a.pcd"))
        self.assertIn("given for clouds of a bag", self.refused("decode", "run.mcap", "--columns", "xyz", "-o", "a.pcd"))
        self.assertIn("a format without", self.refused("decode", "run.mcap", "-o", "a.png"))
        self.assertIn("no such file", self.refused("decode", "missing.pcap", "-o", "a.pcd").lower())
        self.assertIn("missing.pcap", self.refused("decode", "missing.pcap", "--sensor", "VLP-16", "-o", "a.pcd"))


class Outputs(DecodeTest):
    def setUp(self):
        super().setUp()
        self.succeed("render", *ROOM, "--sensor", "VLP-16", "-o", "scan.pcap")

    def test_every_format_and_column_that_needs_no_measurement_is_written(self):
        for name in ("a.las", "a.bin", "a.csv", "a.exr", "a.bev.png", "a.view.png", "a.instance.png", "a.class.png"):
            with self.subTest(name):
                self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "--frames", "1", "-o", name)
        self.succeed("decode", "scan.pcap", "--sensor", "VLP-16", "--frames", "1", "--columns",
                     "xyz,true_xyz,true_range,instance,class,primitive", "-o", "b.npz")
        [name] = [name for name in self.files() if name.startswith("b")]
        found = self.arrays(name)
        self.assertTrue(np.isnan(found["true_range"]).all())
        for column in ("instance", "class", "primitive"):
            self.assertTrue((found[column] == 0xFFFFFFFF).all(), column)

    def test_what_packets_do_not_have_is_refused(self):
        decode = ("decode", "scan.pcap", "--sensor", "VLP-16")
        self.assertIn("a recording of all sensors", self.refused(*decode, "-o", "a.mcap"))
        self.assertIn("packets have no poses", self.refused(*decode, "-o", "a.pcd", "--frame", "world"))
        self.assertIn("packets have no poses", self.refused(*decode, "-o", "a.pcd", "--deskew"))
        self.assertIn("the frame was cast without it", self.refused(*decode, "-o", "a.pcd", "--columns", "normal"))


if __name__ == "__main__":
    unittest.main()
