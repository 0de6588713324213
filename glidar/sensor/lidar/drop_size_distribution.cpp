// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/drop_size_distribution.hpp>

#include <glidar/math/elementary.hpp>

#include <numbers>

namespace glidar {
namespace {

constexpr double kPerMillimetre = 1e3;  // in 1/m

/// Fresnel reflectance at normal incidence.
constexpr double reflectance(double index) {
  return (index - 1.0) / (index + 1.0) * (index - 1.0) / (index + 1.0);
}

constexpr double kWater = reflectance(1.328);
constexpr double kIce = reflectance(1.3031);

}  // namespace

DropSizes rain_sizes(double mm_per_h) {
  return {.number_per_m4 = 8000.0 * kPerMillimetre,
          .slope_per_m = 4.1 * kPerMillimetre * portable_pow(mm_per_h, -0.21),
          .reflectance = kWater};
}

DropSizes snow_sizes(double mm_per_h, Weather::SnowModel model) {
  if (model == Weather::SnowModel::gunn_marshall) {
    return {.number_per_m4 = 7600.0 * kPerMillimetre * portable_pow(mm_per_h, -0.87),
            .slope_per_m = 2.55 * kPerMillimetre * portable_pow(mm_per_h, -0.48),
            .reflectance = kIce};
  }
  return {.number_per_m4 = 2500.0 * kPerMillimetre * portable_pow(mm_per_h, -0.94),
          .slope_per_m = 2.29 * kPerMillimetre * portable_pow(mm_per_h, -0.45),
          .reflectance = kIce};
}

double drops_per_m3(const DropSizes& sizes, double min_diameter_m) {
  const double depth = sizes.slope_per_m * min_diameter_m;
  constexpr double kNoDrops = 600.0;  // e^-600
  return depth < kNoDrops ? sizes.number_per_m4 / sizes.slope_per_m * portable_exp(-depth) : 0.0;
}

double geometric_extinction_per_m(const DropSizes& sizes) {
  const double slope = sizes.slope_per_m;
  return std::numbers::pi * sizes.number_per_m4 / (slope * slope * slope);
}

}  // namespace glidar
