# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The rig of a scene as a robot description, and the command that streams a scene."""

import math
import shlex
from xml.sax.saxutils import quoteattr


def stream_command(scene, driver="", tf="none", frame_prefix="", arguments=""):
    """`glidar stream` with topics of ROS 2. By default a robot description has the frames of the rig."""
    command = ["glidar", "stream", scene, "--ros2", "--tf", tf]
    for name in driver.split():
        command += ["--as", name]
    if frame_prefix:
        command += ["--frame-prefix", frame_prefix]
    return command + shlex.split(arguments)


def rpy(quaternion):
    """Roll, pitch and yaw of w, x, y, z: rotations about the fixed axes x, y and z, as URDF has them."""
    w, x, y, z = quaternion
    sine = 2 * (w * y - z * x)
    if abs(sine) > 1 - 1e-12:  # x points up or down: roll and yaw turn about one axis
        return 0.0, math.copysign(math.pi / 2, sine), -math.copysign(2.0, sine) * math.atan2(x, w)
    return (math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), math.asin(sine),
            math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def robot_description(sensors):
    """URDF of base_link and a link for each sensor: (name, [x, y, z, qw, qx, qy, qz]) of each in the rig."""
    parts = ['<?xml version="1.0"?>', '<robot name="glidar">', '  <link name="base_link"/>']
    for name, pose in sensors:
        place = " ".join(f"{value:.9g}" for value in pose[:3])
        turn = " ".join(f"{value:.9g}" for value in rpy(pose[3:]))
        parts += [f"  <link name={quoteattr(name)}/>",
                  f"  <joint name={quoteattr(name + '_joint')} type=\"fixed\">",
                  f"    <parent link=\"base_link\"/><child link={quoteattr(name)}/>",
                  f'    <origin xyz="{place}" rpy="{turn}"/>', "  </joint>"]
    return "\n".join([*parts, "</robot>"]) + "\n"
