// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/range_noise.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kPulseFwhmPerSigma = 2.3548200450309493;  // 2 sqrt(2 ln 2)
constexpr double kMinIntensity = 1e-9;  // intensity 0 would have an infinite error

inline double clamp_intensity(double intensity) {
  return intensity > kMinIntensity ? intensity : kMinIntensity;
}

/// A variance as a function of the intensity I: the sum of constant, per_intensity / I and
/// per_intensity_squared / I^2.
struct Spread {
  double constant_m2 = 0.0;
  double per_intensity_m2 = 0.0;
  double per_intensity_squared_m2 = 0.0;
};

GLIDAR_SIMD void add_linear(double sigma_m, double sigma_per_m, const Batch<double>& normal,
                            NoiseBatch& b) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double sigma = (sigma_m + sigma_per_m * b.range_m[i]) * b.scale[i];
    b.range_m[i] += sigma * normal[i];
    b.variance_m2[i] += sigma * sigma;
  }
}

GLIDAR_SIMD void add_by_signal(const Spread& spread, const Batch<double>& normal, NoiseBatch& b) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double inverse = 1.0 / clamp_intensity(b.intensity[i]);
    const double sigma = std::sqrt(spread.constant_m2 + spread.per_intensity_m2 * inverse +
                                   spread.per_intensity_squared_m2 * inverse * inverse) *
                         b.scale[i];
    b.range_m[i] += sigma * normal[i];
    b.variance_m2[i] += sigma * sigma;
  }
}

GLIDAR_SIMD void add_uniform_model(const RangeUniform& step, const PairBatch& x, double variance,
                                   NoiseBatch& b) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double additive = step.additive_m * b.scale[i];
    const double multiplicative = step.multiplicative * b.range_m[i] * b.scale[i];
    b.range_m[i] += additive * x.first[i] + multiplicative * x.second[i];
    b.variance_m2[i] += (additive * additive + multiplicative * multiplicative) * variance;
  }
}

GLIDAR_SIMD void quantise(double step_m, double offset_m, NoiseBatch& b) {
  const double variance = step_m * step_m / 12.0;
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double steps = std::floor((b.range_m[i] + offset_m) / step_m + 0.5);
    b.range_m[i] = steps * step_m - offset_m;
    b.variance_m2[i] += variance;
  }
}

GLIDAR_SIMD void to_symmetric_uniforms(PairBatch& uniforms) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    uniforms.first[i] = 2.0 * uniforms.first[i] - 1.0;
    uniforms.second[i] = 2.0 * uniforms.second[i] - 1.0;
  }
}

}  // namespace

double pulse_sigma_m(const RangeCrlb& model, double amplitude) {
  const double sigma_p = model.pulse_fwhm_s / kPulseFwhmPerSigma;
  const double sqrt_pi = 1.0 / std::numbers::inv_sqrtpi;
  return kHalfLight_m_per_s * (model.noise / amplitude) *
         std::sqrt(2.0 * sigma_p * model.sample_s / sqrt_pi);
}

double photon_sigma_m(const RangeShotNoise& model, double amplitude) {
  const double sigma_p = model.pulse_fwhm_s / kPulseFwhmPerSigma;
  return kHalfLight_m_per_s * sigma_p / std::sqrt(model.photons_at_full_scale * amplitude);
}

void apply(const RangeGaussian& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the range", normal);
  add_linear(step.sigma_m, step.sigma_per_m, normal, batch);
}

void apply(const RangeSnr& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the range", normal);
  add_by_signal({.constant_m2 = step.floor_m * step.floor_m,
                 .per_intensity_m2 = step.k_m * step.k_m / step.snr_at_full_scale},
                normal, batch);
}

void apply(const RangeCrlb& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the range", normal);
  const double sigma_m = pulse_sigma_m(step, 1.0);
  add_by_signal({.per_intensity_squared_m2 = sigma_m * sigma_m}, normal, batch);
}

void apply(const RangeShotNoise& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the range", normal);
  const double sigma_m = photon_sigma_m(step, 1.0);
  add_by_signal({.per_intensity_m2 = sigma_m * sigma_m}, normal, batch);
}

void apply(const RangeUniform& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  constexpr const char* kAdditive = "additive error";
  constexpr const char* kMultiplicative = "multiplicative error";
  PairBatch x;
  if (step.distribution == RangeUniform::Distribution::normal) {
    sample_normals(batch.sampler, kAdditive, kMultiplicative, x);
    add_uniform_model(step, x, 1.0, batch);
    return;
  }
  sample_uniforms(batch.sampler.key, x);
  record_uniform(batch.sampler, kAdditive, x.first);
  record_uniform(batch.sampler, kMultiplicative, x.second);
  to_symmetric_uniforms(x);
  add_uniform_model(step, x, 1.0 / 3.0, batch);  // variance of a uniform number in -1..1
}

void apply(const RangeQuantization& step, const NoiseView& view, NoiseBatch& batch) {
  quantise(step.step_m, view.beams.range_offset_m, batch);
}

void describe(RangeGaussian& step, FieldVisitor& visitor) {
  visitor.number({"sigma_m", "standard deviation at range 0", kUnitMetre}, kFromZero, step.sigma_m);
  visitor.number({"sigma_per_m", "added for each metre of range"}, kFromZero, step.sigma_per_m);
}

void describe(RangeSnr& step, FieldVisitor& visitor) {
  visitor.number({"floor_m", "standard deviation of strong signals", kUnitMetre}, kFromZero,
                 step.floor_m);
  visitor.number({"k_m", "standard deviation at an SNR of 1", kUnitMetre, kRequired}, kFromZero,
                 step.k_m);
  visitor.number({"snr_at_full_scale", "SNR of an intensity of 1", kNoUnit, kRequired}, kAboveZero,
                 step.snr_at_full_scale);
}

void describe(RangeCrlb& step, FieldVisitor& visitor) {
  visitor.number({"pulse_fwhm_ns", "duration of the pulse, full width at half maximum",
                  kUnitNanosecond, kRequired},
                 kAboveZero, step.pulse_fwhm_s);
  visitor.number({"sample_ns", "time between samples", kUnitNanosecond, kRequired}, kAboveZero,
                 step.sample_s);
  visitor.number(
      {"noise", "standard deviation of a sample, in units of intensity", kNoUnit, kRequired},
      kFromZero, step.noise);
}

void describe(RangeShotNoise& step, FieldVisitor& visitor) {
  visitor.number({"pulse_fwhm_ns", "duration of the pulse, full width at half maximum",
                  kUnitNanosecond, kRequired},
                 kAboveZero, step.pulse_fwhm_s);
  visitor.number(
      {"photons_at_full_scale", "photo-electrons of an intensity of 1", kNoUnit, kRequired},
      kAboveZero, step.photons_at_full_scale);
}

void describe(RangeUniform& step, FieldVisitor& visitor) {
  using Distribution = RangeUniform::Distribution;
  constexpr std::array<Named<Distribution>, 2> kNames = {
      {{"uniform", Distribution::uniform}, {"normal", Distribution::normal}}};
  visitor.number({"additive_m", "factor of the additive error", kUnitMetre}, kFromZero,
                 step.additive_m);
  visitor.number({"multiplicative", "factor of the error relative to the range"}, kFromZero,
                 step.multiplicative);
  visit_choice(visitor, {"distribution", "of both errors"}, kNames, step.distribution);
}

void describe(RangeQuantization& step, FieldVisitor& visitor) {
  visitor.number({"step_m", "distance between reported ranges", kUnitMetre, kRequired}, kAboveZero,
                 step.step_m);
}

}  // namespace glidar
