// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/weather.hpp>

namespace glidar {

/// Size distribution of drops or flakes: number_per_m4 exp(-slope_per_m D) per metre of diameter D
/// and cubic metre of air.
struct DropSizes {
  double number_per_m4 = 0.0;
  double slope_per_m = 1.0;
  double reflectance = 0.0;  ///< |(n - 1) / (n + 1)|^2, at normal incidence (Fresnel)
};

/// Smaller drops are mist: too many and too faint for echoes of their own.
inline constexpr double kMinDrop_m = 5e-5;

/// Marshall and Palmer, J. Meteor. 5 (1948) 165: 8000 / m^3 / mm, slope 4.1 / mm (mm/h)^-0.21; of
/// water, n = 1.328.
DropSizes rain_sizes(double mm_per_h);

/// By melted diameters, of ice, n = 1.3031. Gunn and Marshall: 7600 / m^3 / mm (mm/h)^-0.87 (as in
/// Kilic et al.'s LISA, arXiv:2107.07004), slope 2.55 / mm (mm/h)^-0.48; Sekhon and Srivastava:
/// 2500 / m^3 / mm (mm/h)^-0.94, slope 2.29 / mm (mm/h)^-0.45.
DropSizes snow_sizes(double mm_per_h, Weather::SnowModel model);

/// Number of drops per cubic metre that are larger than a diameter.
double drops_per_m3(const DropSizes& sizes, double min_diameter_m);

/// Twice the sum of the cross-sections, because large drops remove light by blocking and by
/// diffraction (van de Hulst, "Light scattering by small particles", 8.22). The integral of
/// pi/4 D^2 N(D) is pi/2 number / slope^3.
double geometric_extinction_per_m(const DropSizes& sizes);

}  // namespace glidar
