# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""`glidar stream --ros2` on a scene: ros2 launch glidar_ros2 stream.launch.py scene:=rig.yaml driver:=velodyne"""

from glidar_ros2.rig import stream_command
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration

ARGUMENTS = {
    "scene": ("", "scene file or model"),
    "driver": ("", "drivers of --as, separated by spaces"),
    "tf": ("ground_truth", "poses in /tf: ground_truth, odom, map or none"),
    "frame_prefix": ("", "before the names of frames"),
    "arguments": ("", "further options of glidar stream"),
}


def run(context):
    values = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    return [ExecuteProcess(cmd=stream_command(**values), output="screen")]


def generate_launch_description():
    declared = [DeclareLaunchArgument(name, default_value=value, description=text) for name, (value, text) in ARGUMENTS.items()]
    return LaunchDescription([*declared, OpaqueFunction(function=run)])
