// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the names that steps of noise and their numbers have in files. The reader
// and the sidecar go by the same lists.

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/noise/noise.hpp>

#include <array>
#include <numbers>
#include <variant>

namespace glidar {

/// The names of the steps, in the order of NoiseStep.
inline constexpr std::array kNoiseTypes = {
    "range_gaussian",   "range_snr",          "range_crlb",
    "range_shot_noise", "range_uniform",      "range_quantization",
    "range_bias",       "range_drift",        "dropout",
    "crosstalk",        "false_alarms",       "disparity_quantization",
    "kinect_v1",        "khoshelham",         "nguyen_axial",
    "nguyen_lateral",   "icl_kinect",         "stereo",
    "continuous_wave",  "intensity_gaussian", "intensity_scale",
    "pointing_jitter",  "encoder_error"};
static_assert(kNoiseTypes.size() == std::variant_size_v<NoiseStep>);

/// A number of a step: its key, where it is, how much of its unit inside one of the file's is, and
/// what the file may say.
template <class Step>
struct NoiseNumber {
  const char* key;
  double Step::*number;
  NumberRule rule = kFromZero;
  double unit = 1.0;
  bool is_needed = false;
};

inline constexpr double kDegree_rad = std::numbers::pi / 180.0;
inline constexpr double kNanosecond_s = 1e-9;

inline constexpr NumberRule kBelowOne = {0.0, 1.0 - 1e-9, false, "a number from 0 to below 1"};
inline constexpr NumberRule kUpToOne = {1e-9, 1.0, false, "a number above 0, up to 1"};
inline constexpr NumberRule kAboveOne = {1.0, 1e300, true, "a finite number above 1"};
inline constexpr NumberRule kDriftTime = {0.0, 1e6, true, "seconds above 0 and below 1e6"};
inline constexpr NumberRule kSmallAngle = {0.0, 5.0, false, "degrees from 0 to 5"};

// One list for each struct.

inline auto number_fields(const RangeGaussian& /*step*/) {
  using Step = RangeGaussian;
  return std::array{
      NoiseNumber<Step>{.key = "sigma_m", .number = &Step::sigma_m},
      NoiseNumber<Step>{.key = "sigma_per_m", .number = &Step::sigma_per_m},
  };
}

inline auto number_fields(const RangeSnr& /*step*/) {
  using Step = RangeSnr;
  return std::array{
      NoiseNumber<Step>{.key = "floor_m", .number = &Step::floor_m},
      NoiseNumber<Step>{.key = "k_m", .number = &Step::k_m, .is_needed = true},
      NoiseNumber<Step>{.key = "snr_at_full_scale",
                        .number = &Step::snr_at_full_scale,
                        .rule = kAboveZero,
                        .is_needed = true},
  };
}

inline auto number_fields(const RangeCrlb& /*step*/) {
  using Step = RangeCrlb;
  return std::array{
      NoiseNumber<Step>{.key = "pulse_fwhm_ns",
                        .number = &Step::pulse_fwhm_s,
                        .rule = kAboveZero,
                        .unit = kNanosecond_s,
                        .is_needed = true},
      NoiseNumber<Step>{.key = "sample_ns",
                        .number = &Step::sample_s,
                        .rule = kAboveZero,
                        .unit = kNanosecond_s,
                        .is_needed = true},
      NoiseNumber<Step>{.key = "noise", .number = &Step::noise, .is_needed = true},
  };
}

inline auto number_fields(const RangeShotNoise& /*step*/) {
  using Step = RangeShotNoise;
  return std::array{
      NoiseNumber<Step>{.key = "pulse_fwhm_ns",
                        .number = &Step::pulse_fwhm_s,
                        .rule = kAboveZero,
                        .unit = kNanosecond_s,
                        .is_needed = true},
      NoiseNumber<Step>{.key = "photons_at_full_scale",
                        .number = &Step::photons_at_full_scale,
                        .rule = kAboveZero,
                        .is_needed = true},
  };
}

inline auto number_fields(const RangeUniform& /*step*/) {
  using Step = RangeUniform;
  return std::array{
      NoiseNumber<Step>{.key = "additive_m", .number = &Step::additive_m},
      NoiseNumber<Step>{.key = "multiplicative", .number = &Step::multiplicative},
  };
}

inline auto number_fields(const RangeQuantization& /*step*/) {
  using Step = RangeQuantization;
  return std::array{
      NoiseNumber<Step>{
          .key = "step_m", .number = &Step::step_m, .rule = kAboveZero, .is_needed = true},
  };
}

inline auto number_fields(const RangeBias& /*step*/) {
  using Step = RangeBias;
  return std::array{
      NoiseNumber<Step>{.key = "offset_m", .number = &Step::offset_m, .rule = kFinite},
      NoiseNumber<Step>{.key = "sigma_m", .number = &Step::sigma_m},
  };
}

inline auto number_fields(const RangeDrift& /*step*/) {
  using Step = RangeDrift;
  return std::array{
      NoiseNumber<Step>{.key = "sigma_m", .number = &Step::sigma_m, .is_needed = true},
      NoiseNumber<Step>{
          .key = "tau_s", .number = &Step::tau_s, .rule = kDriftTime, .is_needed = true},
  };
}

inline auto number_fields(const Dropout& /*step*/) {
  using Step = Dropout;
  return std::array{
      NoiseNumber<Step>{.key = "probability", .number = &Step::probability, .rule = kZeroToOne},
  };
}

inline auto number_fields(const Crosstalk& /*step*/) {
  using Step = Crosstalk;
  return std::array{
      NoiseNumber<Step>{.key = "probability",
                        .number = &Step::probability,
                        .rule = kZeroToOne,
                        .is_needed = true},
      NoiseNumber<Step>{.key = "near_m", .number = &Step::near_m},
  };
}

inline auto number_fields(const FalseAlarms& /*step*/) {
  using Step = FalseAlarms;
  return std::array{
      NoiseNumber<Step>{.key = "rate_hz", .number = &Step::rate_hz, .is_needed = true},
      NoiseNumber<Step>{.key = "near_m", .number = &Step::near_m},
      NoiseNumber<Step>{
          .key = "far_m", .number = &Step::far_m, .rule = kAboveZero, .is_needed = true},
      NoiseNumber<Step>{.key = "intensity", .number = &Step::intensity},
  };
}

inline auto number_fields(const DisparityQuantization& /*step*/) {
  using Step = DisparityQuantization;
  return std::array{
      NoiseNumber<Step>{.key = "k_m", .number = &Step::k_m, .rule = kAboveZero, .is_needed = true},
      NoiseNumber<Step>{.key = "offset_steps", .number = &Step::offset_steps, .rule = kFinite},
  };
}

inline auto number_fields(const KinectV1& /*step*/) {
  using Step = KinectV1;
  return std::array{
      NoiseNumber<Step>{.key = "k_m", .number = &Step::k_m, .rule = kAboveZero},
      NoiseNumber<Step>{.key = "offset_steps", .number = &Step::offset_steps, .rule = kFinite},
      NoiseNumber<Step>{.key = "sigma_steps", .number = &Step::sigma_steps},
  };
}

inline auto number_fields(const Khoshelham& /*step*/) {
  using Step = Khoshelham;
  return std::array{
      NoiseNumber<Step>{.key = "sigma_per_m", .number = &Step::sigma_per_m},
  };
}

inline auto number_fields(const NguyenAxial& /*step*/) {
  using Step = NguyenAxial;
  return std::array{
      NoiseNumber<Step>{.key = "a_m", .number = &Step::a_m},
      NoiseNumber<Step>{.key = "b_per_m", .number = &Step::b_per_m},
      NoiseNumber<Step>{.key = "c_m", .number = &Step::c_m, .rule = kFinite},
      NoiseNumber<Step>{.key = "grazing_coefficient", .number = &Step::grazing_coefficient},
  };
}

inline auto number_fields(const NguyenLateral& /*step*/) {
  using Step = NguyenLateral;
  return std::array{
      NoiseNumber<Step>{.key = "a_px", .number = &Step::a_px},
      NoiseNumber<Step>{.key = "b_px", .number = &Step::b_px},
  };
}

inline auto number_fields(const IclKinect& /*step*/) {
  using Step = IclKinect;
  return std::array{
      NoiseNumber<Step>{.key = "k_m", .number = &Step::k_m, .rule = kAboveZero},
      NoiseNumber<Step>{.key = "lateral_px", .number = &Step::lateral_px},
      NoiseNumber<Step>{.key = "sigma_steps", .number = &Step::sigma_steps},
  };
}

inline auto number_fields(const Stereo& /*step*/) {
  using Step = Stereo;
  return std::array{
      NoiseNumber<Step>{
          .key = "focal_px", .number = &Step::focal_px, .rule = kAboveZero, .is_needed = true},
      NoiseNumber<Step>{
          .key = "baseline_m", .number = &Step::baseline_m, .rule = kAboveZero, .is_needed = true},
      NoiseNumber<Step>{.key = "sigma_px", .number = &Step::sigma_px, .is_needed = true},
      NoiseNumber<Step>{.key = "step_px", .number = &Step::step_px},
  };
}

inline auto number_fields(const ContinuousWave& /*step*/) {
  using Step = ContinuousWave;
  return std::array{
      NoiseNumber<Step>{.key = "electrons_at_full_scale",
                        .number = &Step::electrons_at_full_scale,
                        .rule = kAboveZero,
                        .is_needed = true},
      NoiseNumber<Step>{.key = "background_electrons", .number = &Step::background_electrons},
      NoiseNumber<Step>{.key = "contrast", .number = &Step::contrast, .rule = kUpToOne},
      NoiseNumber<Step>{.key = "multipath_fraction", .number = &Step::mixing, .rule = kBelowOne},
      NoiseNumber<Step>{.key = "min_coherence", .number = &Step::min_coherence, .rule = kZeroToOne},
      NoiseNumber<Step>{.key = "max_phase_residual", .number = &Step::max_phase_residual},
  };
}

inline auto number_fields(const IntensityGaussian& /*step*/) {
  using Step = IntensityGaussian;
  return std::array{
      NoiseNumber<Step>{.key = "sigma", .number = &Step::sigma},
      NoiseNumber<Step>{.key = "relative", .number = &Step::relative},
  };
}

inline auto number_fields(const IntensityScale& /*step*/) {
  using Step = IntensityScale;
  return std::array{
      NoiseNumber<Step>{.key = "gain", .number = &Step::gain, .rule = kAboveZero},
      NoiseNumber<Step>{.key = "reference_m", .number = &Step::reference_m},
      NoiseNumber<Step>{.key = "largest", .number = &Step::largest, .rule = kAboveOne},
  };
}

inline auto number_fields(const PointingJitter& /*step*/) {
  using Step = PointingJitter;
  return std::array{
      NoiseNumber<Step>{.key = "sigma_azimuth_deg",
                        .number = &Step::sigma_azimuth_rad,
                        .rule = kSmallAngle,
                        .unit = kDegree_rad},
      NoiseNumber<Step>{.key = "sigma_elevation_deg",
                        .number = &Step::sigma_elevation_rad,
                        .rule = kSmallAngle,
                        .unit = kDegree_rad},
  };
}

inline auto number_fields(const EncoderError& /*step*/) {
  using Step = EncoderError;
  return std::array{
      NoiseNumber<Step>{
          .key = "step_deg", .number = &Step::step_rad, .rule = kSmallAngle, .unit = kDegree_rad},
      NoiseNumber<Step>{.key = "eccentricity_deg",
                        .number = &Step::eccentricity_rad,
                        .rule = kSmallAngle,
                        .unit = kDegree_rad},
      NoiseNumber<Step>{
          .key = "phase_deg", .number = &Step::phase_rad, .rule = kFinite, .unit = kDegree_rad},
      NoiseNumber<Step>{.key = "turn_sigma_deg",
                        .number = &Step::turn_sigma_rad,
                        .rule = kSmallAngle,
                        .unit = kDegree_rad},
  };
}

}  // namespace glidar
