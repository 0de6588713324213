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
  if (is_byte_scale(step)) return byte_of_reflectance(step, reflectance);
  if (step.kind == IntensityScale::Kind::linear) return reflectance;
  return std::clamp(reflectance, 0.0, 1.0);
}

double range_compensation(const IntensityScale& step, double range_m) {
  if (!(step.reference_m > 0.0)) return 1.0;
  const double ratio = range_m / step.reference_m;
  return step.range_exponent == 2.0 ? ratio * ratio : portable_pow(ratio, step.range_exponent);
}

double whole(double value) {
  return std::floor(value + 0.5);
}

}  // namespace

bool is_byte_scale(const IntensityScale& scale) {
  return scale.kind == IntensityScale::Kind::vendor || scale.kind == IntensityScale::Kind::percent;
}

double byte_of_reflectance(const IntensityScale& scale, double reflectance) {
  if (!(reflectance > 0.0)) return 0.0;
  constexpr double kMaxByte = 255.0;
  if (scale.kind == IntensityScale::Kind::percent)
    return std::min(kMaxByte, whole(100.0 * reflectance));
  const double white = scale.diffuse_counts;
  if (reflectance <= 1.0) return whole(white * reflectance);
  const double share = portable_log(reflectance) / portable_log(scale.max_reflectance);
  return white + 1.0 + whole((kMaxByte - 1.0 - white) * std::min(share, 1.0));
}

double reflectance_of_byte(const IntensityScale& scale, double byte) {
  if (scale.kind == IntensityScale::Kind::percent) return byte / 100.0;
  const double white = scale.diffuse_counts;
  if (!(byte > white)) return byte / white;
  return portable_exp((byte - white - 1.0) / (254.0 - white) * portable_log(scale.max_reflectance));
}

void apply(const IntensityGaussian& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the intensity", normal);
  disturb(step, normal, batch);
}

void apply(const IntensityScale& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (!is_hit(batch, i)) continue;
    const double compensation = range_compensation(step, batch.range_m[i]);
    batch.intensity[i] = scaled_intensity(step, step.gain * batch.intensity[i] * compensation);
  }
}

void describe(IntensityGaussian& step, FieldVisitor& visitor) {
  visitor.number({"sigma", "standard deviation at intensity 0"}, kFromZero, step.sigma);
  visitor.number({"relative", "added, relative to the intensity"}, kFromZero, step.relative);
}

void describe(IntensityScale& step, FieldVisitor& visitor) {
  using Kind = IntensityScale::Kind;
  constexpr std::array<Named<Kind>, 4> kNames = {{{"unit", Kind::unit},
                                                  {"vendor", Kind::vendor},
                                                  {"linear", Kind::linear},
                                                  {"percent", Kind::percent}}};
  constexpr NumberRule kAboveOne = {1.0, 1e300, true, "a finite number above 1"};
  visitor.number({"gain", "factor"}, kAboveZero, step.gain);
  visitor.number({"reference_m", "range of the range compensation; 0: none", kUnitMetre}, kFromZero,
                 step.reference_m);
  visitor.number({"range_exponent", "of the range compensation"}, kFromZero, step.range_exponent);
  visitor.number({"diffuse_counts", "what `vendor` reports for a white diffuse surface"},
                 {1.0, 253.0, false, "a number from 1 to 253"}, step.diffuse_counts);
  visitor.number({"max_reflectance", "reflectance that `vendor` reports as 255"}, kAboveOne,
                 step.max_reflectance);
  visit_choice(visitor, {"kind", "of the reported numbers"}, kNames, step.kind);
}

}  // namespace glidar
