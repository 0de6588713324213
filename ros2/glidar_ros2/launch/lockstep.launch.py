# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The lock-step node, and robot_state_publisher with the rig of the scene:

ros2 launch glidar_ros2 lockstep.launch.py scene:=rig.yaml"""

from glidar_ros2.lockstep import Server
from glidar_ros2.rig import robot_description
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def run(context):
    scene = LaunchConfiguration("scene").perform(context)
    prefix = LaunchConfiguration("frame_prefix").perform(context)
    server = Server(scene)
    sensors = [(sensor["name"], sensor["rig_from_sensor"]) for sensor in server.client.describe()["sensors"]]
    server.stop()
    return [
        Node(package="glidar_ros2", executable="lockstep", name="glidar",
             parameters=[{"scene": scene, "frame_prefix": prefix,
                          "rate_hz": float(LaunchConfiguration("rate_hz").perform(context))}]),
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": robot_description(sensors), "frame_prefix": prefix, "use_sim_time": True}]),
    ]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("scene", description="scene file with a rig"),
        DeclareLaunchArgument("frame_prefix", default_value="", description="before the names of frames"),
        DeclareLaunchArgument("rate_hz", default_value="10.0", description="frames per second of simulated time"),
        OpaqueFunction(function=run),
    ])
