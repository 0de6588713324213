// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/constant_twist.hpp>

#include <glidar/motion/times.hpp>

namespace glidar {

Pose pose_at(const ConstantTwist& twist, std::int64_t t_ns) {
  const double s = seconds_between(twist.t0_ns, t_ns);
  const Pose moved = se3_exp(twist.angular_rad_s * s, twist.linear_m_s * s);
  return twist.frame == TwistFrame::body ? twist.pose * moved : moved * twist.pose;
}

}  // namespace glidar
