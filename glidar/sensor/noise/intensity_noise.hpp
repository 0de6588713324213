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
/// reference)^2 if the sensor compensates the range.
///  linear: unchanged.
///  unit: clipped to 0..1.
///  vendor: an integer from 0 to 255: round(100 rho) up to 100 for diffuse surfaces;
///  101 + round(154 ln(rho) / ln(max_reflectance)), up to 255, for retro-reflectors.
struct IntensityScale {
  static constexpr TypeInfo kType = {
      "intensity_scale",
      "ρ = gain I, times (R/reference)² if set; `linear`: unchanged; `unit`: clipped to 0..1; "
      "`vendor`: round(100 ρ), for retro-reflectors 101 + round(154 ln ρ / ln max_reflectance)",
      "0-100 and 101-255 as Velodyne"};
  enum class Kind : std::uint8_t { unit, vendor, linear };
  Kind kind = Kind::unit;
  double gain = 1.0;
  double reference_m = 0.0;        ///< 0: no range compensation
  double max_reflectance = 100.0;  ///< reflectance of the value 255
};

double vendor_intensity(double reflectance, double max_reflectance);
/// The apparent reflectance of a vendor intensity, the inverse of the scale.
double vendor_reflectance(double intensity, double max_reflectance);

/// Keys in sensor files.
void describe(IntensityGaussian& step, FieldVisitor& visitor);
void describe(IntensityScale& step, FieldVisitor& visitor);

void apply(const IntensityGaussian& step, const NoiseView& view, NoiseBatch& batch);
void apply(const IntensityScale& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
