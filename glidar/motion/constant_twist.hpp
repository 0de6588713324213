// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstdint>

namespace glidar {

/// Whose axes and origin a twist is given in.
enum class TwistFrame : std::uint8_t {
  body,   ///< the moving body's: linear is the velocity of its origin, along its own axes
  world,  ///< the world's: linear is the velocity of that point of the body (imagined to reach so
          ///< far) which passes the world's origin ("spatial twist")
};

/// A steady screw motion: pose exp(twist s) for a twist in the body's frame, exp(twist s) pose for
/// one in the world's, s seconds after t0 (Lynch & Park, "Modern Robotics" (2017), section 3.3.2).
struct ConstantTwist {
  Pose pose = Pose::Identity();  ///< at t0_ns
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  TwistFrame frame = TwistFrame::body;
  std::int64_t t0_ns = 0;
};

Pose pose_at(const ConstantTwist& twist, std::int64_t t_ns);

}  // namespace glidar
