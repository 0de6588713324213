// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/phong_shading.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/gaussian.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// Equation (3): attenuation at the distance d between surface and sensor.
inline double attenuation(const PhongHeadlight& light, double d) {
  return 1.0 / (light.attenuation_constant + light.attenuation_linear_per_m * d +
                light.attenuation_quadratic_per_m2 * d * d);
}

/// max(n . h, 0) with the half-vector h = l of equation (2): l = v = -direction.
inline float clamped_cosine(float cos_shading) {
  return cos_shading > 0.0F ? cos_shading : 0.0F;
}

/// The ambient and diffuse terms of equation (5).
inline float ambient_and_diffuse(const Reflectance& surface, float ambient, float n_dot_h) {
  return ambient * surface.ambient + surface.diffuse * n_dot_h;
}

/// Equations (3) to (5) without the specular term. Returns true if a surface has one.
GLIDAR_SIMD bool shade_diffuse(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  const Hits& hits = frame.ground_truth;
  const auto ambient = static_cast<float>(light.ambient);
  unsigned specular = 0;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Reflectance& surface = hits.reflectance[i];
    const float n_dot_h = clamped_cosine(hits.cos_shading[i]);
    const auto received = static_cast<float>(attenuation(light, hits.range_m[i])) *
                          ambient_and_diffuse(surface, ambient, n_dot_h);
    frame.intensity[i] = frame.status[i] == Status::hit ? received : 0.0F;
    specular |= static_cast<unsigned>(surface.specular > 0.0F);
  }
  return specular != 0;
}

GLIDAR_SIMD void raise(Batch<double>& base, const Batch<double>& exponent) {
  for (std::size_t k = 0; k < kSampleBatch; ++k) base[k] = portable_pow(base[k], exponent[k]);
}

/// Equations (3) to (5) for the surfaces of a batch that have a specular term.
void measure_specular(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  const Hits& hits = frame.ground_truth;
  const auto ambient = static_cast<float>(light.ambient);
  Batch<double> lobe{};
  Batch<double> shininess{};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    lobe[i - range.begin] = clamped_cosine(hits.cos_shading[i]);
    shininess[i - range.begin] = hits.reflectance[i].shininess;
  }
  raise(lobe, shininess);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Reflectance& surface = hits.reflectance[i];
    if (frame.status[i] != Status::hit || !(surface.specular > 0.0F)) continue;
    const float colour =
        ambient_and_diffuse(surface, ambient, clamped_cosine(hits.cos_shading[i])) +
        surface.specular * static_cast<float>(lobe[i - range.begin]);
    frame.intensity[i] = static_cast<float>(attenuation(light, hits.range_m[i])) * colour;
  }
}

}  // namespace

void validate(const PhongHeadlight& light) {
  const auto good = [](double value) { return std::isfinite(value) && value >= 0.0; };
  const double sum = light.attenuation_constant + light.attenuation_linear_per_m +
                     light.attenuation_quadratic_per_m2;
  if (good(light.attenuation_constant) && good(light.attenuation_linear_per_m) &&
      good(light.attenuation_quadratic_per_m2) && good(light.ambient) && sum > 0.0) {
    return;
  }
  throw Error({.where = "light",
               .found = "a number is negative or not finite, or all attenuation coefficients are 0",
               .allowed = "finite numbers of at least 0, and one attenuation coefficient above 0",
               .remedy = ""});
}

void shade_phong(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  for (std::size_t begin = range.begin; begin < range.end; begin += kSampleBatch) {
    const BeamRange run{begin, std::min(begin + kSampleBatch, range.end)};
    if (shade_diffuse(light, run, frame)) measure_specular(light, run, frame);
  }
}

}  // namespace glidar
