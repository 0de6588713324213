// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace glidar {

/// A rigid transform, named `target_from_source`: p_target = target_from_source * p_source.
/// Right-handed, metres, double precision.
using Pose = Eigen::Isometry3d;

/// The largest coordinate and scale that poses may have; beyond, squares no longer fit single
/// precision.
inline constexpr double kMaxCoordinate_m = 1e15;

/// The pose of a camera at `eye` whose boresight (+z) points at `target` and whose image shows
/// `up` upwards (optical frame, REP-103: x right, y down, z forward).
/// Throws Error when a number is not finite or too large, eye and target coincide or `up` is
/// parallel to the boresight.
Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up);

/// The same without an up direction: +z of the world is up in the image. Where the line of sight is
/// vertical (its angle to +z or -z has a sine of at most kVerticalSine) that is not defined, and +x
/// of the world is up: seen from above, the picture is a map with x upwards.
/// No rule can be continuous there (a sphere has no tangent field without a zero).
Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// Sine of the angle to the vertical up to which a line of sight counts as vertical: 1 um at 1 m.
inline constexpr double kVerticalSine = 1e-6;

/// Turns the axes of bodies and LiDARs (x forward, y left, z up) into the optical frame's (x right,
/// y down, z forward), REP-103. look_at(...) * optical_from_body() aims a sensor whose boresight is
/// +x.
Pose optical_from_body();

/// The 2015 program's sensor frame: x left, y up, z forward. The optical frame (x right, y down)
/// turned by pi about z.
Pose woods2016_from_optical();

/// The pose with this attitude and position; the quaternion is normalised.
/// Throws Error when it is zero or anything is not finite or beyond kMaxCoordinate_m.
Pose make_pose(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);

/// The exponential of a twist, in SE(3): the motion of a screw that turns by `rotation_rad` (axis
/// times angle) while the body's origin moves on by `translation_m` as seen from the moving body.
/// Lynch & Park, "Modern Robotics" (2017), equation 3.88.
Pose se3_exp(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m);

/// A pose as files list it: position x y z in metres, unit quaternion w x y z with w not negative.
using PoseVector = Eigen::Matrix<double, 7, 1>;
PoseVector to_xyz_wxyz(const Pose& pose);

/// True when every number is finite and the linear part is a rotation to within `tolerance`.
bool is_rigid(const Pose& pose, double tolerance = 1e-9);

}  // namespace glidar
