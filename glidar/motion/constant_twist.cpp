// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/constant_twist.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/motion/rate_keys.hpp>
#include <glidar/motion/times.hpp>

namespace glidar {

Pose pose_at(const ConstantTwist& twist, std::int64_t t_ns) {
  const double s = seconds_between(twist.t0_ns, t_ns);
  const Pose moved = se3_exp(twist.angular_rad_s * s, twist.linear_m_s * s);
  return twist.frame == TwistFrame::body ? twist.pose * moved : moved * twist.pose;
}

void describe(ConstantTwist& twist, FieldVisitor& visitor) {
  constexpr std::array<Named<TwistFrame>, 2> kFrames = {
      {{"body", TwistFrame::body}, {"world", TwistFrame::world}}};
  visit_rate(visitor, false, twist.angular_rad_s);
  visit_velocity(visitor, "`[x, y, z]`", twist.linear_m_s);
  visit_choice(visitor,
               {"frame",
                "`body`: rate and velocity are along the axes of the body; `world`: along those of "
                "the world, and the velocity is that of the point of the body at the origin of the "
                "world"},
               kFrames, twist.frame);
}

}  // namespace glidar
