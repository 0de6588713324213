# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The messages of ROS 2 as classes of the package cyclonedds, written from the definitions of ROS."""

from cyclonedds.idl import annotations, make_idl_struct, types

F32, F64, U8, U32, I32 = types.float32, types.float64, types.uint8, types.uint32, types.int32


def message(package, name, *members):
    """A final struct with the name that ROS gives it in DDS."""
    struct = make_idl_struct(f"{name}_", f"{package}::msg::dds_::{name}_", dict(members))
    return annotations.final(annotations.autoid("sequential")(struct))


Time = message("builtin_interfaces", "Time", ("sec", I32), ("nanosec", U32))
Header = message("std_msgs", "Header", ("stamp", Time), ("frame_id", str))
PointField = message("sensor_msgs", "PointField", ("name", str), ("offset", U32), ("datatype", U8), ("count", U32))
PointCloud2 = message(
    "sensor_msgs", "PointCloud2", ("header", Header), ("height", U32), ("width", U32),
    ("fields", types.sequence[PointField]), ("is_bigendian", bool), ("point_step", U32), ("row_step", U32),
    ("data", types.sequence[U8]), ("is_dense", bool))
LaserScan = message(
    "sensor_msgs", "LaserScan", ("header", Header), ("angle_min", F32), ("angle_max", F32), ("angle_increment", F32),
    ("time_increment", F32), ("scan_time", F32), ("range_min", F32), ("range_max", F32),
    ("ranges", types.sequence[F32]), ("intensities", types.sequence[F32]))
Image = message("sensor_msgs", "Image", ("header", Header), ("height", U32), ("width", U32), ("encoding", str),
                ("is_bigendian", U8), ("step", U32), ("data", types.sequence[U8]))
CompressedImage = message("sensor_msgs", "CompressedImage", ("header", Header), ("format", str),
                          ("data", types.sequence[U8]))
RegionOfInterest = message("sensor_msgs", "RegionOfInterest", ("x_offset", U32), ("y_offset", U32), ("height", U32),
                           ("width", U32), ("do_rectify", bool))
CameraInfo = message(
    "sensor_msgs", "CameraInfo", ("header", Header), ("height", U32), ("width", U32), ("distortion_model", str),
    ("d", types.sequence[F64]), ("k", types.array[F64, 9]), ("r", types.array[F64, 9]), ("p", types.array[F64, 12]),
    ("binning_x", U32), ("binning_y", U32), ("roi", RegionOfInterest))
Vector3 = message("geometry_msgs", "Vector3", ("x", F64), ("y", F64), ("z", F64))
Point = message("geometry_msgs", "Point", ("x", F64), ("y", F64), ("z", F64))
Quaternion = message("geometry_msgs", "Quaternion", ("x", F64), ("y", F64), ("z", F64), ("w", F64))
Imu = message(
    "sensor_msgs", "Imu", ("header", Header), ("orientation", Quaternion),
    ("orientation_covariance", types.array[F64, 9]), ("angular_velocity", Vector3),
    ("angular_velocity_covariance", types.array[F64, 9]), ("linear_acceleration", Vector3),
    ("linear_acceleration_covariance", types.array[F64, 9]))
Transform = message("geometry_msgs", "Transform", ("translation", Vector3), ("rotation", Quaternion))
TransformStamped = message("geometry_msgs", "TransformStamped", ("header", Header), ("child_frame_id", str),
                           ("transform", Transform))
TFMessage = message("tf2_msgs", "TFMessage", ("transforms", types.sequence[TransformStamped]))
Pose = message("geometry_msgs", "Pose", ("position", Point), ("orientation", Quaternion))
PoseStamped = message("geometry_msgs", "PoseStamped", ("header", Header), ("pose", Pose))
PoseWithCovariance = message("geometry_msgs", "PoseWithCovariance", ("pose", Pose),
                             ("covariance", types.array[F64, 36]))
Twist = message("geometry_msgs", "Twist", ("linear", Vector3), ("angular", Vector3))
TwistWithCovariance = message("geometry_msgs", "TwistWithCovariance", ("twist", Twist),
                              ("covariance", types.array[F64, 36]))
Odometry = message("nav_msgs", "Odometry", ("header", Header), ("child_frame_id", str), ("pose", PoseWithCovariance),
                   ("twist", TwistWithCovariance))
Clock = message("rosgraph_msgs", "Clock", ("clock", Time))

MESSAGES = {kind.__name__[:-1]: kind
            for kind in (PointCloud2, LaserScan, Image, CompressedImage, CameraInfo, Imu, TFMessage, PoseStamped, Clock,
                         Odometry)}
