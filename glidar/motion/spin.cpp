// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/spin.hpp>

#include <glidar/motion/rate_keys.hpp>
#include <glidar/motion/times.hpp>

namespace glidar {

Pose pose_at(const Spin& spin, std::int64_t t_ns) {
  const double s = seconds_between(spin.t0_ns, t_ns);
  return spin.pose * se3_exp(spin.rate_rad_s * s, Eigen::Vector3d::Zero());
}

void describe(Spin& spin, FieldVisitor& visitor) {
  visit_rate(visitor, true, spin.rate_rad_s);
}

}  // namespace glidar
