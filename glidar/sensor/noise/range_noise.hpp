// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

#include <cstdint>

namespace glidar {

class FieldVisitor;
struct NoiseBatch;
struct NoiseView;

/// Normal range error with the standard deviation sigma + sigma_per_m R (RobotecGPULidar,
/// docs/GaussianNoise.md).
struct RangeGaussian {
  static constexpr TypeInfo kType = {"range_gaussian", "R + (sigma_m + sigma_per_m R) x",
                                     "RobotecGPULidar, docs/GaussianNoise.md"};
  double sigma_m = 0.0;
  double sigma_per_m = 0.0;
};

/// Normal range error with sigma^2 = floor^2 + k^2 / SNR, SNR = snr_at_full_scale times
/// intensity. k = 0.30 m fits the OS1 (gen 1 data sheet: 1.5, 3, 10 cm at SNR 250, 100, 12).
struct RangeSnr {
  static constexpr TypeInfo kType = {"range_snr",
                                     "σ² = floor² + k² / SNR, SNR = snr_at_full_scale I",
                                     "fits Ouster's OS1 gen 1 data sheet with k = 0.30 m"};
  double floor_m = 0.0;
  double k_m = 0.0;
  double snr_at_full_scale = 1.0;
};

/// Timing of a sampled Gaussian pulse in white noise at the Cramer-Rao bound:
/// sigma_t = (noise / A) sqrt(2 sigma_p dt / sqrt(pi)), where A is the intensity; sigma_R = c
/// sigma_t / 2 (Kay, Fundamentals of Statistical Signal Processing I, 3.11, for a Gaussian pulse).
struct RangeCrlb {
  static constexpr TypeInfo kType = {
      "range_crlb", "σ = (c/2) (noise / I) √(2 σ_p Δt / √π)",
      "Cramér-Rao bound of a sampled Gaussian pulse (Kay 1993, 3.11)"};
  double pulse_fwhm_s = 0.0;
  double sample_s = 0.0;
  double noise = 0.0;  ///< standard deviation per sample, in units of intensity
};

/// Shot-noise-limited timing: sigma_R = (c / 2) sigma_p / sqrt(N) with N photo-electrons (the mean
/// of N arrival times).
struct RangeShotNoise {
  static constexpr TypeInfo kType = {"range_shot_noise", "σ = (c/2) σ_p / √N, N = photons I",
                                     "mean of N arrival times"};
  double pulse_fwhm_s = 0.0;
  double photons_at_full_scale = 0.0;
};

/// The noise of the original GLIDAR, which did not state its distribution:
/// R' = R + additive x + multiplicative R y. x and y are uniform in -1..1, or standard normal.
struct RangeUniform {
  static constexpr TypeInfo kType = {
      "range_uniform", "R + additive u + multiplicative R v; u, v uniform in -1..1, or `normal`",
      "the original GLIDAR of 2015, which did not state its distribution"};
  enum class Distribution : std::uint8_t { uniform, normal };
  double additive_m = 0.0;
  double multiplicative = 0.0;
  Distribution distribution = Distribution::uniform;
};

/// Rounds the range to a multiple of a step. Adds step^2 / 12 to the variance.
struct RangeQuantization {
  static constexpr TypeInfo kType = {
      "range_quantization",
      "R plus the sensor's range offset, rounded to whole steps; σ² + step²/12",
      "rounding error, uniform over a step"};
  double step_m = 0.0;
};

/// Standard deviations of the models above, metres.
double pulse_sigma_m(const RangeCrlb& model, double amplitude);
double photon_sigma_m(const RangeShotNoise& model, double amplitude);

/// Keys in sensor files.
void describe(RangeGaussian& step, FieldVisitor& visitor);
void describe(RangeSnr& step, FieldVisitor& visitor);
void describe(RangeCrlb& step, FieldVisitor& visitor);
void describe(RangeShotNoise& step, FieldVisitor& visitor);
void describe(RangeUniform& step, FieldVisitor& visitor);
void describe(RangeQuantization& step, FieldVisitor& visitor);

void apply(const RangeGaussian& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeSnr& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeCrlb& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeShotNoise& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeUniform& step, const NoiseView& view, NoiseBatch& batch);
void apply(const RangeQuantization& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
