// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/phong_shading.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>
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

/// Raises the first `count` numbers, rounded up to whole vectors.
GLIDAR_SIMD void raise(std::size_t count, const Batch<double>& exponent, Batch<double>& base) {
  constexpr std::size_t kWidth = 8;
  for (std::size_t first = 0; first < count; first += kWidth) {
    for (std::size_t k = first; k < first + kWidth; ++k) {
      base[k] = portable_pow(base[k], exponent[k]);
    }
  }
}

/// What the specular term raises to a power, and the exponents.
GLIDAR_SIMD void find_lobes(BeamRange range, const Hits& hits, Batch<double>& lobe,
                            Batch<double>& shininess) {
  const float* const cos_shading = hits.cos_shading.data() + range.begin;
  const Reflectance* const surface = hits.reflectance.data() + range.begin;
  for (std::size_t k = 0; k < range.end - range.begin; ++k) {
    lobe[k] = clamped_cosine(cos_shading[k]);
    shininess[k] = surface[k].shininess;
  }
}

/// Equations (3) to (5) where a surface has a specular term.
GLIDAR_SIMD void shade_specular(const PhongHeadlight& light, BeamRange range,
                                const Batch<double>& lobe, Frame& frame) {
  const Hits& hits = frame.ground_truth;
  const auto ambient = static_cast<float>(light.ambient);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Reflectance& surface = hits.reflectance[i];
    const float colour =
        ambient_and_diffuse(surface, ambient, clamped_cosine(hits.cos_shading[i])) +
        surface.specular * static_cast<float>(lobe[i - range.begin]);
    const float received = static_cast<float>(attenuation(light, hits.range_m[i])) * colour;
    const bool is_lit = frame.status[i] == Status::hit && surface.specular > 0.0F;
    frame.intensity[i] = is_lit ? received : frame.intensity[i];
  }
}

/// Equations (3) to (5) for a batch with surfaces that have a specular term.
void measure_specular(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  Batch<double> lobe{};
  Batch<double> shininess{};
  find_lobes(range, frame.ground_truth, lobe, shininess);
  raise(range.end - range.begin, shininess, lobe);
  shade_specular(light, range, lobe, frame);
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
               .allowed = "finite numbers of at least 0, and one attenuation coefficient above 0"});
}

void shade_phong(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  for (std::size_t begin = range.begin; begin < range.end; begin += kSampleBatch) {
    const BeamRange run{begin, std::min(begin + kSampleBatch, range.end)};
    if (shade_diffuse(light, run, frame)) measure_specular(light, run, frame);
  }
}

}  // namespace glidar
