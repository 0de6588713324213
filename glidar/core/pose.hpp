// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/portable.hpp>

#include <Eigen/Geometry>

namespace glidar {

/// The rotation about a unit vector. Unlike Eigen::AngleAxis, which calls the C library, it has the
/// same bits on any machine.
inline Eigen::Quaterniond axis_angle(const Eigen::Vector3d& axis, double angle_rad) {
  const SineCosine half = portable_sincos(0.5 * angle_rad);
  const Eigen::Vector3d vector = half.sine * axis;
  return {half.cosine, vector.x(), vector.y(), vector.z()};
}

/// Rotations about the fixed axes x, then y, then z (REP-103).
inline Eigen::Quaterniond roll_pitch_yaw(const Eigen::Vector3d& rpy_rad) {
  return axis_angle(Eigen::Vector3d::UnitZ(), rpy_rad.z()) *
         axis_angle(Eigen::Vector3d::UnitY(), rpy_rad.y()) *
         axis_angle(Eigen::Vector3d::UnitX(), rpy_rad.x());
}

/// A rigid transform, named `target_from_source`: p_target = target_from_source * p_source.
/// Right-handed, metres, double precision.
using Pose = Eigen::Isometry3d;

/// The maximum coordinate and scale of poses; squares of larger numbers overflow single precision.
inline constexpr double kMaxCoordinate_m = 1e15;

/// Whether all coordinates (m) are finite and within kMaxCoordinate_m.
bool is_within_reach(const Eigen::Vector3d& position_m);

/// world_from_camera of a camera at `eye` (m) whose boresight (+z) points at `target` (m) and whose
/// image shows `up` upwards (optical frame, REP-103: x right, y down, z forward).
/// Throws Error if a number is not finite or too large, eye and target coincide or `up` is
/// parallel to the boresight.
Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up);

/// The same with the world's +z as the up direction. For a vertical line of sight (the sine of its
/// angle to +z or -z is at most kVerticalSine), +x of the world is up: seen from above, the image
/// is a map with x upwards. No rule is continuous there (hairy ball theorem).
Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// Maximum sine of the angle between a vertical line of sight and the vertical: 1 um at 1 m.
inline constexpr double kVerticalSine = 1e-6;

/// Rotation from the axes of bodies and LiDARs (x forward, y left, z up) to those of the optical
/// frame (x right, y down, z forward), REP-103. look_at(...) * optical_from_body() is the pose of a
/// sensor whose boresight is +x.
Pose optical_from_body();

/// Rotation from the optical frame (x right, y down, z forward) to the sensor frame of the original
/// GLIDAR (x left, y up, z forward): pi about z.
Pose woods2016_from_optical();

/// The pose with this orientation and position (m); the quaternion is normalised.
/// Throws Error if it is zero, or if a number is not finite or above kMaxCoordinate_m.
Pose make_pose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);

/// The exponential map of SE(3): the screw motion that rotates by `rotation_rad` (axis times angle)
/// while the body's origin translates by `translation_m`, in the axes of the moving body. Lynch and
/// Park, "Modern Robotics" (2017), equation 3.88.
Pose se3_exp(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m);

/// A pose as files store it: position x y z in metres, unit quaternion w x y z with w >= 0.
using PoseVector = Eigen::Matrix<double, 7, 1>;
PoseVector to_xyz_wxyz(const Pose& pose);

/// True if every number is finite and the linear part is a rotation within `tolerance`.
bool is_rigid(const Pose& pose, double tolerance = 1e-9);

}  // namespace glidar
