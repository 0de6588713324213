// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/light.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// Equation (3): attenuation over the distance d between surface and sensor.
double attenuation(const Light& light, double d) {
  return 1.0 / (light.attenuation_constant + light.attenuation_linear_per_m * d +
                light.attenuation_quadratic_per_m2 * d * d);
}

/// Equation (5) for one beam: ambient, diffuse and specular, with the half-vector h = l of (2).
float surface_light(const Reflectance& surface, float ambient, float n_dot_h) {
  const float lit = std::max(n_dot_h, 0.0F);
  float colour = ambient * surface.ambient + surface.diffuse * lit;
  if (surface.specular > 0.0F) colour += surface.specular * std::pow(lit, surface.shininess);
  return colour;
}

}  // namespace

void validate(const Light& light) {
  const auto good = [](double value) { return std::isfinite(value) && value >= 0.0; };
  const double sum = light.attenuation_constant + light.attenuation_linear_per_m +
                     light.attenuation_quadratic_per_m2;
  if (good(light.attenuation_constant) && good(light.attenuation_linear_per_m) &&
      good(light.attenuation_quadratic_per_m2) && good(light.ambient) && sum > 0.0) {
    return;
  }
  throw Error({.where = "light",
               .found = "a number is negative or not finite, or all attenuation is 0",
               .allowed = "finite numbers from 0, with at least one attenuation above 0",
               .remedy = ""});
}

void measure_intensity(const Light& light, const Beams& beams, BeamRange range, Frame& frame) {
  const Hits& truth = frame.truth;
  const auto ambient = static_cast<float>(light.ambient);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (frame.status[i] != Status::hit) {
      frame.intensity[i] = 0.0F;
      continue;
    }
    const Eigen::Vector3f h = -beams.directions[i].cast<float>();  // equation (2), l = v
    const float colour =
        surface_light(truth.reflectance[i], ambient, truth.shading_normal[i].dot(h));
    frame.intensity[i] = static_cast<float>(attenuation(light, truth.range_m[i])) * colour;  // (4)
  }
}

}  // namespace glidar
