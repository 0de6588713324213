// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/intensity_noise.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

GLIDAR_SIMD void disturb(const IntensityGaussian& step, const Batch<double>& normal,
                         NoiseBatch& b) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double sigma = (step.sigma + step.relative * b.intensity[i]) * b.scale[i];
    const double disturbed = b.intensity[i] + sigma * normal[i];
    b.intensity[i] = disturbed > 0.0 ? disturbed : 0.0;
  }
}

double scaled_intensity(const IntensityScale& step, double reflectance) {
  switch (step.kind) {
    case IntensityScale::Kind::vendor:
      return vendor_intensity(reflectance, step.max_reflectance);
    case IntensityScale::Kind::linear:
      return reflectance;
    default:
      return std::clamp(reflectance, 0.0, 1.0);
  }
}

}  // namespace

double vendor_intensity(double reflectance, double max_reflectance) {
  if (!(reflectance > 0.0)) return 0.0;
  if (reflectance <= 1.0) return std::floor(100.0 * reflectance + 0.5);
  const double share = portable_log(reflectance) / portable_log(max_reflectance);
  return 101.0 + std::floor(154.0 * std::min(share, 1.0) + 0.5);
}

double vendor_reflectance(double intensity, double max_reflectance) {
  if (!(intensity > 100.0)) return intensity / 100.0;
  return portable_exp((intensity - 101.0) / 154.0 * portable_log(max_reflectance));
}

void apply(const IntensityGaussian& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the intensity", normal);
  disturb(step, normal, batch);
}

void apply(const IntensityScale& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  const bool compensates = step.reference_m > 0.0;
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (!is_hit(batch, i)) continue;
    const double times = compensates ? batch.range_m[i] / step.reference_m : 1.0;
    batch.intensity[i] = scaled_intensity(step, step.gain * batch.intensity[i] * times * times);
  }
}

void describe(IntensityGaussian& step, FieldVisitor& visitor) {
  visitor.number({"sigma", "standard deviation at intensity 0"}, kFromZero, step.sigma);
  visitor.number({"relative", "added, relative to the intensity"}, kFromZero, step.relative);
}

void describe(IntensityScale& step, FieldVisitor& visitor) {
  using Kind = IntensityScale::Kind;
  constexpr std::array<Named<Kind>, 3> kNames = {
      {{"unit", Kind::unit}, {"vendor", Kind::vendor}, {"linear", Kind::linear}}};
  constexpr NumberRule kAboveOne = {1.0, 1e300, true, "a finite number above 1"};
  visitor.number({"gain", "factor"}, kAboveZero, step.gain);
  visitor.number({"reference_m", "range of the range compensation; 0: none", kUnitMetre}, kFromZero,
                 step.reference_m);
  visitor.number({"max_reflectance", "reflectance that `vendor` reports as 255"}, kAboveOne,
                 step.max_reflectance);
  visit_choice(visitor, {"kind", "of the reported numbers"}, kNames, step.kind);
}

}  // namespace glidar
