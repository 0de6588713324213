// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_camera/ambient_light.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/sensor/depth_camera/light_power.hpp>

namespace glidar {

void describe(AmbientLight& light, FieldVisitor& visitor) {
  visitor.number({"ambient_w_per_m2",
                  "irradiance of every surface by light from all sides, within the passband, W/m²"},
                 kLightPowerRule, light.ambient_w_per_m2);
  visitor.number(
      {"sun_w_per_m2", "irradiance of a surface that faces the sun, within the passband, W/m²"},
      kLightPowerRule, light.sun_w_per_m2);
  Eigen::Vector3d direction = light.sun_direction;
  if (visitor.vector(
          {"sun_direction", "towards the sun, in the world frame", kNoUnit, false, "[0, 0, 1]"},
          {-1e6, 1e6, false, "a number from -1e6 to 1e6"}, true, direction)) {
    light.sun_direction = direction;
  }
  if (visitor.is_reading() && !(light.sun_direction.norm() > 0.0)) {
    visitor.reject("sun_direction", "a vector without direction", "a vector that is not zero");
  }
}

}  // namespace glidar
