// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <cstdint>

namespace glidar {

class FieldVisitor;

/// The coordinate frame of a twist.
enum class TwistFrame : std::uint8_t {
  body,   ///< the moving body: linear is the velocity of its origin, in its own axes
  world,  ///< the world ("spatial twist"): linear is the velocity of the point of the body,
          ///< extended if necessary, at the world's origin
};

/// A constant screw motion: pose exp(twist s) for a twist in the body frame, exp(twist s) pose for
/// one in the world frame, s seconds after t0 (Lynch and Park, "Modern Robotics" (2017), section
/// 3.3.2).
struct ConstantTwist {
  Pose pose = Pose::Identity();  ///< at t0_ns
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  TwistFrame frame = TwistFrame::body;
  std::int64_t t0_ns = 0;
};

Pose pose_at(const ConstantTwist& twist, std::int64_t t_ns);

/// Keys of `twist`; files have the pose beside it, at time 0.
void describe(ConstantTwist& twist, FieldVisitor& visitor);

}  // namespace glidar
