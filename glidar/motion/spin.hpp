// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstdint>

namespace glidar {

/// Turning on the spot at a constant rate: the rates of the 2015 program's --object-rate and
/// --sensor-rate. The rate is an angular velocity along the body's own axes (right-handed, axis
/// times rad/s), as in the kinematics which that program cites: Markley, "Attitude error
/// representations for Kalman filtering", J. Guidance, Control, and Dynamics 26(2) (2003),
/// equation 10. The rate being constant, the axis is fixed in the world too.
struct Spin {
  Pose pose = Pose::Identity();  ///< at t0_ns; its position stays
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  std::int64_t t0_ns = 0;
};

Pose pose_at(const Spin& spin, std::int64_t t_ns);

}  // namespace glidar
