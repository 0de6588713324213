// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/rate_keys.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose.hpp>

namespace glidar {

void visit_rate(FieldVisitor& visitor, bool is_required, Eigen::Vector3d& rate_rad_s) {
  constexpr NumberRule kRate = {-1e9, 1e9, false, "a number from -1e9 to 1e9"};
  visitor.at_most_one({{"rate_rad_s", "rate_deg_s"},
                       "one of rate_rad_s, rate_deg_s",
                       is_required ? "the rate is missing" : nullptr,
                       "add 'rate_rad_s: [0, 0, 0.1]'"});
  visitor.vector({"rate_rad_s",
                  "`[x, y, z]`: axis times angle per second, right-handed",
                  {"rad/s"},
                  false,
                  is_required ? "required, or `rate_deg_s`" : "0"},
                 kRate, visitor.is_writing(), rate_rad_s);
  if (visitor.is_writing()) return;
  visitor.vector({"rate_deg_s",
                  "the same in degrees",
                  {"degrees/s", kDegree},
                  false,
                  is_required ? "required, or `rate_rad_s`" : "0"},
                 kRate, false, rate_rad_s);
}

void visit_velocity(FieldVisitor& visitor, const char* text, Eigen::Vector3d& velocity_m_s) {
  visitor.vector({"velocity_m_s", text, {"m/s"}, false, "0"},
                 {-kMaxCoordinate_m, kMaxCoordinate_m, false, "a number from -1e15 to 1e15"},
                 visitor.is_writing(), velocity_m_s);
}

}  // namespace glidar
