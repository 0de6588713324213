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

}  // namespace glidar
