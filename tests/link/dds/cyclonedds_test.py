#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""A newer Cyclone DDS (the C library in the package cyclonedds of PyPI), whose readers announce type information
of XTypes, reads all topics: the messages are those of the bag writer, and the writer stays alive. It also publishes
poses."""

import json
import unittest

from dds_support import DdsTest, bag_messages, same_message, skip_without, wait_for_line, wait_until
from skipping import importing

skip_without("GLIDAR_DDS_PEER")
with importing():
    from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsParticipant, BuiltinTopicDcpsPublication
    from cyclonedds.core import Policy, Qos, ReadCondition, SampleState, ViewState, InstanceState, WaitSet
    from cyclonedds.domain import Domain, DomainParticipant
    from cyclonedds.pub import DataWriter
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic
    from cyclonedds.util import duration

import ros_types
from ros_types import MESSAGES

CONFIG = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>
</General></Domain></CycloneDDS>"""
RELIABLE = Policy.Reliability.Reliable(duration(seconds=1))
ANY = SampleState.Any | ViewState.Any | InstanceState.Any
MAX_WAIT = duration(minutes=5)  # machines may be very busy
ENCLAVE = b"enclave=/;"


def qos(*policies, depth=100):
    return Qos(RELIABLE, Policy.History.KeepLast(depth), Policy.DataRepresentation(use_cdrv0_representation=True),
               *policies)


class CycloneDds(DdsTest):
    def setUp(self):
        super().setUp()
        self.joined = Domain(self.domain, CONFIG)
        self.participant = DomainParticipant(self.domain)

    def reader(self, name, *policies):
        """A reader of /name that discovers types, as newer nodes do."""
        kind = MESSAGES[name if name in MESSAGES else "TFMessage"]
        of = qos(*policies)
        return DataReader(self.participant, Topic(self.participant, f"rt/{name}", kind, qos=of), qos=of)

    def take(self, reader, count):
        """The next messages, as CDR."""
        waiting = WaitSet(self.participant)
        condition = ReadCondition(reader, ANY)
        waiting.attach(condition)
        messages = []
        while len(messages) < count:
            self.assertGreater(waiting.wait(MAX_WAIT), 0, "no message")
            messages += [sample.serialize(use_version_2=False) for sample in reader.take(100)
                         if hasattr(sample, "serialize")]
        return messages

    def match(self, readers):
        for reader in readers:
            wait_until(lambda reader=reader: reader.get_matched_publications(), "the publisher")

    def test_messages_of_every_type_arrive_byte_for_byte(self):
        writer = self.peer("samples", "all.rosbag2")
        wait_for_line(writer.stdout, "ready")
        expected = bag_messages(self.folder / "all.rosbag2")
        readers = {name: self.reader(name) for name in MESSAGES}
        received = {name: [] for name in MESSAGES}

        def collect():
            for name, reader in readers.items():
                received[name] += [sample.serialize(use_version_2=False) for sample in reader.take(100)
                                   if hasattr(sample, "serialize")]
            return all(len(messages) >= 3 for messages in received.values())
        self.write_until(writer, collect)
        for _ in range(2):  # it lives after it has seen all type information
            for reader in readers.values():
                reader.take(100)
            self.order(writer, "write")
            wait_for_line(writer.stdout, "written")
            for name, reader in readers.items():
                with self.subTest(name):
                    for message, sample in zip(self.take(reader, 3), expected[f"/{name}"], strict=True):
                        self.assertTrue(same_message(message, sample), message.hex())
        self.assertIsNone(writer.poll())

    def test_late_readers_get_static_transforms(self):
        writer = self.peer("samples", "all.rosbag2")
        wait_for_line(writer.stdout, "ready")
        expected = bag_messages(self.folder / "all.rosbag2")["/TFMessage"][0]
        reader = self.reader("tf_static", Policy.Durability.TransientLocal)
        self.assertTrue(same_message(self.take(reader, 1)[0], expected))

    def test_publishers_are_those_of_a_ros_node(self):
        writer = self.peer("samples", "all.rosbag2")
        wait_for_line(writer.stdout, "ready")
        readers = [self.reader(name) for name in MESSAGES]
        self.match(readers)
        publications = {sample.topic_name: sample for sample in
                        BuiltinDataReader(self.participant, BuiltinTopicDcpsPublication).take(1000)}
        cloud = publications["rt/PointCloud2"]
        self.assertEqual(cloud.type_name, "sensor_msgs::msg::dds_::PointCloud2_")
        self.assertEqual(bytes(cloud.qos[Policy.Userdata].data),
                         b"typehash=RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5;")
        self.assertIsInstance(cloud.qos[Policy.Reliability], Policy.Reliability.Reliable)
        self.assertEqual(cloud.qos[Policy.Durability], Policy.Durability.Volatile)
        self.assertEqual(publications["rt/tf_static"].qos[Policy.Durability], Policy.Durability.TransientLocal)
        participants = BuiltinDataReader(self.participant, BuiltinTopicDcpsParticipant).take(100)
        self.assertIn(ENCLAVE, [bytes(sample.qos[Policy.Userdata].data) for sample in participants
                                if Policy.Userdata in sample.qos])

    def test_topics_of_a_driver_arrive_with_its_qos_fields_and_dates(self):
        """`--as ouster` with a trajectory that has dates, of which no double holds the nanoseconds."""
        recorded, frame_ns = 1_700_000_000_123_456_789, 10**8
        (self.folder / "drive.tum").write_text("".join(
            f"{1_700_000_000 + k}.123456789 {k} 0 0 0 0 0 1\n" for k in range(3)))
        best_effort = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(5),
                          Policy.DataRepresentation(use_cdrv0_representation=True))

        points = Topic(self.participant, "rt/ouster/points", ros_types.PointCloud2, qos=best_effort)
        cloud_reader, reliable_reader = (DataReader(self.participant, points, qos=of) for of in (best_effort, qos()))
        imu_reader = DataReader(self.participant, Topic(self.participant, "rt/ouster/imu", ros_types.Imu, qos=best_effort),
                                qos=best_effort)
        self.start("glidar", "stream", "builtin:box:size=20,16,6", "--ground-truth", "--sensor", "OS1-32", "--imu", "ICM-20948",
                   "--trajectory", "drive.tum", "--as", "ouster", "--ros2")
        clouds, samples = [], []

        def collect():
            for taken, source in ((clouds, cloud_reader), (samples, imu_reader)):
                taken += [sample for sample in source.take(100) if hasattr(sample, "header")]
            return len(clouds) >= 2 and len(samples) >= 5
        wait_until(collect, "clouds and samples")
        self.assertEqual(len(cloud_reader.get_matched_publications()), 1)
        self.assertEqual(reliable_reader.get_matched_publications(), [])  # DLIO and FAST-LIO have such readers
        fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 16, 7), ("t", 20, 6), ("reflectivity", 24, 4),
                  ("ring", 26, 4), ("ambient", 28, 4), ("range", 32, 6)]
        for cloud in clouds:
            stamp_ns = cloud.header.stamp.sec * 10**9 + cloud.header.stamp.nanosec
            self.assertEqual((cloud.header.frame_id, (stamp_ns - recorded) % frame_ns), ("os_lidar", 0))
            self.assertEqual([(field.name, field.offset, field.datatype) for field in cloud.fields], fields)
            self.assertEqual((cloud.height, cloud.width, cloud.point_step), (32, 1024, 48))
            times = sorted({int.from_bytes(bytes(cloud.data[at + 20:at + 24]), "little")
                            for at in range(0, len(cloud.data), 48)})
            self.assertEqual(len(times), 1024)
            self.assertLessEqual(max(abs(t - k * frame_ns / 1024) for k, t in enumerate(times)), 1)
        for sample in samples:
            stamp_ns = sample.header.stamp.sec * 10**9 + sample.header.stamp.nanosec
            self.assertEqual((sample.header.frame_id, (stamp_ns - recorded) % (frame_ns // 10)), ("os_imu", 0))

    def publish(self, topic, kind, samples, *policies):
        """Writes messages until the peer has printed a line, which it returns."""
        of = qos(*policies)
        writer = DataWriter(self.participant, Topic(self.participant, f"rt{topic}", kind, qos=of), qos=of)
        wait_until(lambda: writer.get_publication_matched_status().current_count > 0, "the subscriber")
        for sample in samples:
            writer.write(sample)
        return writer

    @staticmethod
    def header(sec, frame):
        return ros_types.Header(stamp=ros_types.Time(sec=sec, nanosec=5), frame_id=frame)

    @staticmethod
    def odometry(sec, w=1.0):
        pose = ros_types.Pose(position=ros_types.Point(x=1.5, y=2.0, z=3.0),
                              orientation=ros_types.Quaternion(x=0.0, y=0.0, z=0.0, w=w))
        nothing = ros_types.Vector3(x=0.0, y=0.0, z=0.0)
        return ros_types.Odometry(
            header=CycloneDds.header(sec, "odom"), child_frame_id="base_link",
            pose=ros_types.PoseWithCovariance(pose=pose, covariance=[0.0] * 36),
            twist=ros_types.TwistWithCovariance(twist=ros_types.Twist(linear=nothing, angular=nothing),
                                                covariance=[0.0] * 36))

    def test_poses_of_other_publishers_arrive(self):
        peer = self.peer("poses", "/odom")
        nan = float("nan")
        writer = self.publish("/odom", ros_types.Odometry,
                              [self.odometry(1, nan), self.odometry(2, 0.0), self.odometry(3)])
        self.assertEqual(json.loads(peer.stdout.readline()),
                         {"t_ns": 3_000_000_005, "position": [1.5, 2, 3], "quaternion": [0, 0, 0, 1]})
        self.assertIsNone(peer.poll())
        del writer

    def test_transforms_of_other_publishers_arrive(self):
        peer = self.peer("poses", "/tf:map:base")
        unit = ros_types.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)

        def transform(sec, parent, child):
            return ros_types.TransformStamped(
                header=self.header(sec, parent), child_frame_id=child, transform=ros_types.Transform(
                    translation=ros_types.Vector3(x=1.0, y=0.0, z=0.0), rotation=unit))
        writer = self.publish("/tf", ros_types.TFMessage, [
            ros_types.TFMessage(transforms=[transform(4, "map", "odom"), transform(5, "odom", "base")])])
        self.assertEqual(json.loads(peer.stdout.readline()),
                         {"t_ns": 5_000_000_005, "position": [2, 0, 0], "quaternion": [0, 0, 0, 1]})
        del writer


if __name__ == "__main__":
    unittest.main()
