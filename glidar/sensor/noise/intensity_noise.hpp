// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar {

struct NoiseBatch;
struct NoiseView;

/// Normal error of the intensity: I' = max(0, I + (sigma + relative I) x).
struct IntensityGaussian {
  double sigma = 0.0;
  double relative = 0.0;
};

/// How the sensor spells intensity. The apparent reflectance is gain I, or gain I (R / reference)^2
/// where the sensor compensates the range.
///  plain: as it is.
///  unit: clipped to 0..1.
///  vendor: a whole number from 0 to 255: round(100 rho) to 100 for surfaces up to a white one;
///  for retro-reflectors 101 + round(154 ln(rho) / ln(largest)), to 255.
struct IntensityScale {
  enum class Kind : std::uint8_t { unit, vendor, plain };
  Kind kind = Kind::unit;
  double gain = 1.0;
  double reference_m = 0.0;  ///< 0: the range is not compensated
  double largest = 100.0;    ///< reflectance that gives 255
};

double vendor_intensity(double reflectance, double largest);
/// The reflectance that a vendor's intensity stands for: the other way about.
double vendor_reflectance(double intensity, double largest);

void apply(const IntensityGaussian& step, const NoiseView& view, NoiseBatch& batch);
void apply(const IntensityScale& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
