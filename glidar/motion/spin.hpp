// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstdint>

namespace glidar {

class FieldVisitor;

/// Rotation in place at a constant rate: the rates of --object-rate and --sensor-rate, as in the
/// original GLIDAR. The rate is an angular velocity in the body's own axes (right-handed, axis
/// times rad/s), as in the kinematics that the original cites: Markley, "Attitude error
/// representations for Kalman filtering", J. Guidance, Control, and Dynamics 26(2) (2003),
/// equation 10. Because the rate is constant, the axis is fixed in the world too.
struct Spin {
  Pose pose = Pose::Identity();  ///< at t0_ns; the position is constant
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  std::int64_t t0_ns = 0;
};

Pose pose_at(const Spin& spin, std::int64_t t_ns);

/// Keys of `spin`; files have the pose beside it, at time 0.
void describe(Spin& spin, FieldVisitor& visitor);

}  // namespace glidar
