// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/phong_headlight.hpp>

#include <glidar/core/field_visitor.hpp>

namespace glidar {
namespace {

/// Sidecar files have these beside `ambient`, with a longer name.
void visit_attenuation(FieldVisitor& visitor, PhongHeadlight& light) {
  const bool is_flat = visitor.is_report();
  const char* text =
      "light is attenuated by 1 / (constant + linear d + quadratic d²); not all three 0";
  visitor.number({is_flat ? "attenuation_constant" : "constant", text}, kFromZero,
                 light.attenuation_constant);
  visitor.number({is_flat ? "attenuation_linear_per_m" : "linear_per_m", "linear"}, kFromZero,
                 light.attenuation_linear_per_m);
  visitor.number({is_flat ? "attenuation_quadratic_per_m2" : "quadratic_per_m2", "quadratic"},
                 kFromZero, light.attenuation_quadratic_per_m2);
}

}  // namespace

void describe(PhongHeadlight& light, FieldVisitor& visitor) {
  const auto attenuation = [&](FieldVisitor& nested) { visit_attenuation(nested, light); };
  if (visitor.is_report()) {
    visit_attenuation(visitor, light);
  } else {
    visitor.object({"attenuation", "attenuation over the distance d"}, true,
                   FieldVisitor::Describe(attenuation));
  }
  visitor.number({"ambient", "light from everywhere"}, kFromZero, light.ambient);
  if (visitor.is_reading() && light.attenuation_constant == 0.0 &&
      light.attenuation_linear_per_m == 0.0 && light.attenuation_quadratic_per_m2 == 0.0) {
    visitor.reject("attenuation", "all three are 0", "at least one above 0");
  }
}

}  // namespace glidar
