// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

#include <cstdint>

namespace glidar {

class FieldVisitor;
struct NoiseBatch;
struct NoiseView;

/// Normal error of the intensity: I' = max(0, I + (sigma + relative I) x).
struct IntensityGaussian {
  static constexpr TypeInfo kType = {"intensity_gaussian", "max(0, I + (sigma + relative I) x)",
                                     "definition"};
  double sigma = 0.0;
  double relative = 0.0;
};

/// The scale of reported intensities. The apparent reflectance is gain I, or gain I (R /
/// reference)^range_exponent if the sensor compensates the range.
///  linear: unchanged.
///  unit: clipped to 0..1.
///  vendor: an integer from 0 to 255: round(n rho), n = diffuse_counts, for diffuse surfaces;
///  n + 1 + round((254 - n) ln(rho) / ln(max_reflectance)), up to 255, for retro-reflectors.
///  percent: round(100 rho), up to 255.
struct IntensityScale {
  static constexpr TypeInfo kType = {
      "intensity_scale",
      "ρ = gain I, times (R/reference)^range_exponent if set; `linear`: unchanged; `unit`: clipped "
      "to 0..1; `vendor`: round(n ρ), n = diffuse_counts, for retro-reflectors "
      "n + 1 + round((254 - n) ln ρ / ln max_reflectance); `percent`: round(100 ρ), up to 255",
      "n: 100 of Velodyne and Ouster, 110 of the VLS-128, 150 of Livox; `percent`: Hesai"};
  enum class Kind : std::uint8_t { unit, vendor, linear, percent };
  Kind kind = Kind::unit;
  double gain = 1.0;
  double reference_m = 0.0;        ///< 0: no range compensation
  double range_exponent = 2.0;     ///< of the range compensation; as that of the lidar equation
  double max_reflectance = 100.0;  ///< reflectance of the value 255
  double diffuse_counts = 100.0;   ///< value of a white diffuse surface
};

/// Whether the scale reports bytes.
bool is_byte_scale(const IntensityScale& scale);
/// The byte of a reflectance. Requires is_byte_scale().
double byte_of_reflectance(const IntensityScale& scale, double reflectance);
/// The apparent reflectance of a byte, the inverse. Requires is_byte_scale().
double reflectance_of_byte(const IntensityScale& scale, double byte);

/// Keys in sensor files.
void describe(IntensityGaussian& step, FieldVisitor& visitor);
void describe(IntensityScale& step, FieldVisitor& visitor);

void apply(const IntensityGaussian& step, const NoiseView& view, NoiseBatch& batch);
void apply(const IntensityScale& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
