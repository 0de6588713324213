# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the bags of glidar_bag_files with readers that share nothing with the writers.

usage: bag_readers_test.py PROGRAM rosbags|mcap
"""

import functools
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from skipping import importing

START_NS = 1_700_000_000_000_000_000
MESSAGES = 3
FOLDER = None


def topic_of(entry):
    return "/" + entry["ros1_name"].split("/")[1]


def types():
    return json.loads((FOLDER / "types.json").read_text())


def known_types(store):
    """Of rosbags 0.11 or 0.9."""
    return store.fielddefs if hasattr(store, "fielddefs") else store.FIELDDEFS


class RosbagsTest(unittest.TestCase):
    """rosbags: types and hashes computed from definitions, and bytes serialized again."""

    @staticmethod
    @functools.cache
    def store():
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        store = get_typestore(Stores.EMPTY)
        for entry in types():
            definitions = get_types_from_msg(entry["ros2msg"], entry["name"])
            known = known_types(store)
            store.register({name: value for name, value in definitions.items() if name not in known})
        return store

    def test_hashes_follow_from_the_definitions(self):
        store = self.store()
        for entry in types():
            with self.subTest(entry["name"]):
                self.assertIn(entry["name"], known_types(store))
                if hasattr(store, "hash_rihs01"):  # not in rosbags 0.9
                    self.assertEqual(store.hash_rihs01(entry["name"]), entry["type_hash"])

    def test_types_are_those_of_the_distribution(self):
        from rosbags.typesys import Stores, get_typestore

        store = get_typestore(Stores.ROS2_HUMBLE)
        known = [entry for entry in types() if entry["name"] in known_types(store)]
        self.assertGreaterEqual(len(known), 10)
        for entry in known:
            if hasattr(store, "hash_rihs01"):
                self.assertEqual(store.hash_rihs01(entry["name"]), entry["type_hash"])

    def check_bag(self, name):
        from rosbags.highlevel import AnyReader

        expected = {topic_of(entry): entry for entry in types()}
        store = self.store()
        counts = {}
        with AnyReader([FOLDER / name]) as reader:
            self.assertEqual(len(reader.connections), len(expected) + 1)
            for connection, time_ns, raw in reader.messages():
                entry = expected[connection.topic]
                self.assertEqual(connection.msgtype, entry["name"])
                number = counts.get(connection.topic, 0)
                counts[connection.topic] = number + 1
                self.assertEqual(time_ns, START_NS + number)
                message = reader.deserialize(raw, connection.msgtype)
                if hasattr(message, "header"):
                    self.assertEqual(message.header.stamp.sec, 1_700_000_000 + number)
                    self.assertEqual(message.header.frame_id, "lidar_frame")
                again = store.serialize_cdr(message, entry["name"])
                self.assertEqual(bytes(again), bytes(raw), connection.msgtype)
        self.assertEqual(counts, {topic: MESSAGES for topic in expected})

    def test_bags(self):
        for name in ("sqlite.rosbag2", "mcap.rosbag2"):
            with self.subTest(name):
                self.check_bag(name)

    def test_empty_bags(self):
        from rosbags.rosbag2 import Reader

        with Reader(FOLDER / "empty.rosbag2") as reader:
            self.assertEqual(list(reader.messages()), [])

    def test_values(self):
        from rosbags.highlevel import AnyReader

        with AnyReader([FOLDER / "sqlite.rosbag2"]) as reader:
            read = {}
            for connection, _, raw in reader.messages():
                read[connection.topic] = reader.deserialize(raw, connection.msgtype)
        cloud = read["/PointCloud2"]
        self.assertEqual([(f.name, f.offset, f.datatype) for f in cloud.fields],
                         [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("ring", 12, 4)])
        self.assertEqual(bytes(cloud.data), bytes(i * 7 % 256 for i in range(42)))
        self.assertEqual(list(read["/CameraInfo"].p), [21.0 + i for i in range(12)])
        self.assertEqual(read["/Odometry"].twist.twist.angular.z, 0.6)
        self.assertEqual(list(read["/Odometry"].twist.covariance), [101.0 + i for i in range(36)])
        self.assertEqual(read["/TFMessage"].transforms[0].transform.translation.y, 4.0)
        self.assertEqual(read["/CustomMsg"].points[1].offset_time, 200)
        self.assertEqual(read["/CustomMsg"].points[0].line, 3)
        self.assertEqual(read["/VelodyneScan"].packets[1].stamp.nanosec, 6)
        self.assertEqual(bytes(read["/PacketMsg"].buf), bytes([2, 2, 3, 4, 5]))
        self.assertEqual(read["/String"].data, '{"seq": 2}')
        self.assertEqual(read["/LaserScan"].intensities[2], 30.0)
        car, empty = read["/MarkerArray"].markers
        self.assertEqual((car.ns, car.id, car.type, car.text, car.mesh_file.filename), ("car", 7, 1, "a car", "car.obj"))
        self.assertEqual((car.scale.x, car.pose.orientation.w, car.color.b, car.uv_coordinates[0].v), (4.0, 0.8, 0.75, 0.75))
        self.assertEqual((empty.ns, len(empty.points)), ("", 0))


class McapTest(unittest.TestCase):
    """The official Python library, with all checksums."""

    def read(self, name):
        from mcap.reader import make_reader
        from mcap.stream_reader import StreamReader
        from mcap_ros2.decoder import DecoderFactory

        with open(FOLDER / name, "rb") as file:
            # NonSeekingReader checks chunks and the data section, SeekingReader chunks and the summary
            for _ in StreamReader(file, validate_crcs=True).records:
                pass
        with open(FOLDER / name, "rb") as file:
            reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
            return reader.get_header(), reader.get_summary(), list(reader.iter_decoded_messages())

    def test_messages(self):
        expected = {topic_of(entry): entry for entry in types()}
        for name, compression in (("none.mcap", ""), ("lz4.mcap", "lz4"), ("zstd.mcap", "zstd")):
            with self.subTest(name):
                header, summary, messages = self.read(name)
                self.assertEqual(header.profile, "ros2")
                self.assertEqual(len(messages), MESSAGES * len(expected))
                self.assertEqual(summary.statistics.message_count, len(messages))
                self.assertEqual(summary.statistics.message_start_time, START_NS)
                self.assertEqual(summary.statistics.message_end_time, START_NS + MESSAGES - 1)
                self.assertEqual({c.compression for c in summary.chunk_indexes}, {compression})
                self.assertEqual(len(summary.channels), len(expected) + 1)
                for decoded in messages:
                    entry = expected[decoded.channel.topic]
                    self.assertEqual(decoded.schema.name, entry["name"])
                    self.assertEqual(decoded.channel.metadata["topic_type_hash"], entry["type_hash"])
                cloud = [m.decoded_message for m in messages if m.channel.topic == "/PointCloud2"][2]
                self.assertEqual(cloud.header.stamp.sec, 1_700_000_002)
                self.assertEqual(bytes(cloud.data), bytes(i * 7 % 256 for i in range(42)))

    def test_storage_of_a_rosbag2(self):
        _, summary, messages = self.read("mcap.rosbag2/mcap_0.mcap")
        self.assertEqual(summary.statistics.message_count, len(messages))

    def test_the_data_section_has_the_right_checksum(self):
        import zlib

        for name in ("none.mcap", "lz4.mcap", "zstd.mcap"):
            bytes_ = (FOLDER / name).read_bytes()
            summary_start = int.from_bytes(bytes_[-28:-20], "little")
            data_end = summary_start - 13  # opcode, length and the checksum
            self.assertEqual(bytes_[data_end], 0x0F)
            self.assertEqual(int.from_bytes(bytes_[data_end + 9:data_end + 13], "little"),
                             zlib.crc32(bytes_[:data_end]))
            self.assertEqual(int.from_bytes(bytes_[-12:-8], "little"), zlib.crc32(bytes_[summary_start:-12]))

    def test_empty_bags(self):
        _, summary, messages = self.read("empty.mcap")
        self.assertEqual(summary.statistics.message_count, 0)
        self.assertEqual(messages, [])


READERS = {"rosbags": (RosbagsTest, "rosbags"), "mcap": (McapTest, "mcap_ros2")}


def main():
    global FOLDER
    program, reader = sys.argv[1:]
    case, module = READERS[reader]
    with importing():
        __import__(module)
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = pathlib.Path(folder)
        subprocess.run([program, folder], check=True)
        suite = unittest.defaultTestLoader.loadTestsFromTestCase(case)
        return 0 if unittest.TextTestRunner().run(suite).wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
