// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/math/random.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>
#include <glidar/sensor/lidar/weather.hpp>

#include <vector>

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

/// A beam of uniform irradiance with the diameter exit_diameter_m + divergence_rad R.
struct BeamShape {
  double divergence_rad = 0.003;  ///< full angle
  double exit_diameter_m = 0.0;
};

double beam_diameter_m(const BeamShape& beam, double range_m);

/// The beam's volume up to a range: a truncated cone.
double beam_volume_m3(const BeamShape& beam, double range_m);

/// A section of the beam, which ends where the next one begins.
struct DropShell {
  double from_m = 0.0;
  double volume_before_m3 = 0.0;  ///< beam_volume_m3(from_m)
  double mean_before = 0.0;       ///< mean number of drops in all shells before
  double drops_per_m3 = 0.0;      ///< of min_diameter_m and larger
  double min_diameter_m = 0.0;    ///< no smaller drop in this shell can reach the minimum signal
};

/// The detectable drops of a beam. Drops are a Poisson process over range and diameter. So are
/// those above a bound that depends on the range; therefore fainter drops need not be sampled, and
/// samples below the exact bound are rejected (thinning: Lewis and Shedler, Nav. Res. Logist. Q. 26
/// (1979) 403).
struct DropField {
  DropSizes sizes;
  BeamShape beam;
  double min_signal = 0.0;
  std::vector<DropShell> shells = {};  ///< the last has density 0; empty: no drops
};

struct DropEcho {
  double range_m = 0.0;
  double signal = 0.0;
  double diameter_m = 0.0;
};

/// S of a drop: its backscatter is sizes.reflectance times its share of the beam's cross-section,
/// at most 1 (Kilic et al., arXiv:2107.07004).
double drop_signal(const LidarEquation& light, const DropField& field, double range_m,
                   double diameter_m);

DropField drop_field(const LidarEquation& light, const DropSizes& sizes, const BeamShape& beam,
                     double min_signal);

/// Samples the drops in front of a hard target, the nearest first. They depend on `key` only,
/// whose blocks are used from key.block on, not on the range of the target.
void sample_drops(const LidarEquation& light, const DropField& field, double hard_range_m,
                  RngKey key, FunctionRef<void(const DropEcho&)> take);

}  // namespace glidar
