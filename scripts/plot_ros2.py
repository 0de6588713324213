#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/ros2.png: what a program without code of GLIDAR received of `glidar stream examples/drive.yaml --ros2 --tf map`
over DDS. The clouds are placed in the frame `map` by /tf and /tf_static, as RViz places them.

usage: plot_ros2.py GLIDAR_PROGRAM PICTURE.png, by a Python that has cyclonedds 11, NumPy, Pillow and Matplotlib
"""

import io
import os
import subprocess
import sys
import time
from pathlib import Path

DOMAIN = 78
os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)

import matplotlib.pyplot as plt
import numpy as np
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from PIL import Image

sys.path.insert(0, str(Path(__file__).parent.parent / "tests/link/dds"))
from ros_types import MESSAGES  # noqa: E402

LOOPBACK = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>
</General></Domain></CycloneDDS>"""
CLOUDS = 6
MAX_WAIT_S = 120
DATATYPES = {2: "u1", 4: "<u2", 6: "<u4", 7: "<f4", 8: "<f8"}  # of sensor_msgs/PointField


def reader(participant, topic, kind, *policies):
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(1000),
              Policy.DataRepresentation(use_cdrv0_representation=True), *policies)
    return DataReader(participant, Topic(participant, "rt" + topic, MESSAGES[kind], qos=qos), qos=qos)


def nanoseconds(stamp):
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def matrix(transform):
    """target_from_source of a geometry_msgs/Transform."""
    q, t = transform.rotation, transform.translation
    x, y, z, w = q.x, q.y, q.z, q.w
    made = np.eye(4)
    made[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    made[:3, 3] = t.x, t.y, t.z
    return made


def points_of(cloud):
    """The points of a sensor_msgs/PointCloud2 by their fields."""
    row = np.dtype({"names": [field.name for field in cloud.fields],
                    "formats": [DATATYPES[field.datatype] for field in cloud.fields],
                    "offsets": [field.offset for field in cloud.fields], "itemsize": cloud.point_step})
    return np.frombuffer(bytes(cloud.data), row)


def receive(program):
    """Clouds, poses of base_link in map by time, and the pose of the sensor in base_link."""
    domain = Domain(DOMAIN, LOOPBACK)
    participant = DomainParticipant(DOMAIN)
    clouds = reader(participant, "/lidar/points", "PointCloud2")
    moving = reader(participant, "/tf", "TFMessage")
    static = reader(participant, "/tf_static", "TFMessage", Policy.Durability.TransientLocal)
    command = [program, "stream", "examples/drive.yaml", "--ros2", "--tf", "map", "--duration", str(CLOUDS / 10 + 0.5), "--quiet"]
    received, poses, mounts = [], {}, {}
    with subprocess.Popen(command) as simulation:
        end = time.monotonic() + MAX_WAIT_S
        while (len(received) < CLOUDS or not mounts) and time.monotonic() < end:
            received += clouds.take(CLOUDS)
            for message in moving.take(1000):
                for one in message.transforms:
                    poses[nanoseconds(one.header.stamp)] = matrix(one.transform)
            for message in static.take(10):
                mounts.update((one.child_frame_id, matrix(one.transform)) for one in message.transforms)
            time.sleep(0.01)
        simulation.terminate()
    del domain
    if len(received) < CLOUDS:
        raise SystemExit(f"{len(received)} of {CLOUDS} clouds arrived")
    return received, poses, mounts


def camera(eye, target):
    """camera_from_map of a camera with x right, y down, z forward."""
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    made = np.eye(4)
    made[:3, :3] = [right, np.cross(forward, right), forward]
    made[:3, 3] = -made[:3, :3] @ eye
    return made


def project(view, xyz):
    """Image coordinates of points in front of the camera, their depths, and which points these are."""
    seen = xyz @ view[:3, :3].T + view[:3, 3]
    shown = seen[:, 2] > 1
    seen = seen[shown]
    return seen[:, :2] / seen[:, 2:], seen[:, 2], shown


def draw_axes(ax, view, pose, name):
    ends = pose[:3, 3] + np.vstack([np.zeros(3), 1.5 * pose[:3, :3].T])
    image, _, shown = project(view, ends)
    if not shown.all():
        return
    for end, colour in zip(image[1:], ("#ff4444", "#44dd44", "#5588ff")):
        ax.plot(*zip(image[0], end), color=colour, lw=2)
    ax.annotate(name, image[0], color="white", fontsize=9, xytext=(4, -12), textcoords="offset points")


def draw(clouds, poses, mounts, picture):
    stamps = np.array(sorted(poses))
    in_map = [poses[stamps[np.abs(stamps - nanoseconds(cloud.header.stamp)).argmin()]] for cloud in clouds]
    sensors = [pose @ mounts[cloud.header.frame_id] for pose, cloud in zip(in_map, clouds)]
    points = [points_of(cloud) for cloud in clouds]
    xyz = np.concatenate([np.stack([one[axis] for axis in "xyz"], 1) @ pose[:3, :3].T + pose[:3, 3]
                          for one, pose in zip(points, sensors)])
    view = camera(np.array([-13.0, -4.0, 9.0]), np.array([9.0, 0.0, 0.5]))
    figure, ax = plt.subplots(figsize=(10, 5.6), facecolor="#101418", layout="constrained")
    image, depths, shown = project(view, xyz)
    ax.scatter(*image.T, s=60 / depths**2 + 0.15, c=xyz[shown, 2], cmap="turbo", vmin=-0.5, vmax=6, linewidths=0)
    trace, _, _ = project(view, np.array([pose[:3, 3] for pose in sensors]))
    ax.plot(*trace.T, color="white", lw=1, marker=".", ms=4)
    for name, pose in (("map", np.eye(4)), ("base_link", in_map[-1]), (clouds[-1].header.frame_id, sensors[-1])):
        draw_axes(ax, view, pose, name)
    ax.set(xlim=(-0.85, 0.85), ylim=(0.5, -0.42), aspect="equal")
    ax.set_axis_off()
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=80)
    Image.open(drawn).convert("RGB").quantize(96, Image.Quantize.MAXCOVERAGE).save(picture, optimize=True)


if __name__ == "__main__":
    draw(*receive(sys.argv[1]), sys.argv[2])
