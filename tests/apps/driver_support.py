# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Bags of `glidar render --as`, as an independent reader (rosbags) finds them."""

import sys
from pathlib import Path

from cli_support import CliTest

try:
    import numpy as np
    from cloud_message import points_of  # noqa: F401
    from rosbags.highlevel import AnyReader
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

ROOM = ("builtin:box:size=20,16,6", "--eye", "1,2,0", "--ground-truth")
OPEN = ("builtin:box:size=4,4,4", "--eye", "6,0,0", "--ground-truth")  # most beams miss
F32, F64, U8, U16, U32 = 7, 8, 2, 4, 6
XYZI = [("x", 0, F32), ("y", 4, F32), ("z", 8, F32), ("intensity", 12, F32)]


def stamp_s(message):
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


def stamp_ns(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def layout(cloud):
    return [(field.name, field.offset, field.datatype) for field in cloud.fields]


def wrapped(angle):
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi


def rotation(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class DriverTest(CliTest):
    BAG = "run.mcap"

    def publish(self, *arguments, duration="0.1"):
        """Messages by topic, with the time at which they were recorded."""
        self.succeed("render", *arguments, "--duration", duration, "-o", self.BAG)
        found = {}
        with AnyReader([Path(self.folder, self.BAG)]) as reader:
            for connection, time_ns, raw in reader.messages():
                message = reader.deserialize(raw, connection.msgtype)
                found.setdefault(connection.topic, []).append((time_ns, message))
            self.qos = {c.topic: c.ext.offered_qos_profiles for c in reader.connections}
        self.found = found
        return found

    def first(self, topic):
        return self.found[topic][0][1]

    def transforms(self):
        return {t.child_frame_id: (t.header.frame_id, t.transform) for t in self.first("/tf_static").transforms}

    def parents(self):
        return {child: parent for child, (parent, _) in self.transforms().items()}

    def matrix(self, frame):
        """Pose of a frame in base_link."""
        pose = np.eye(4)
        while frame != "base_link":
            parent, transform = self.transforms()[frame]
            step = np.eye(4)
            step[:3, :3] = rotation(transform.rotation)
            step[:3, 3] = [transform.translation.x, transform.translation.y, transform.translation.z]
            pose, frame = step @ pose, parent
        return pose
