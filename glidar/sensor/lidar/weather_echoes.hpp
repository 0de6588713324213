// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/fog.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>
#include <glidar/sensor/lidar/precipitation.hpp>
#include <glidar/sensor/lidar/weather.hpp>

#include <vector>

namespace glidar {

// Fog and drops close to the sensor: signals grow as 1/R^2 down to the range where the beam no
// longer overlaps the receiver's field of view.

/// The range below which the receiver sees nothing: where the overlap table becomes positive, or
/// 0.9 m without such a table.
double min_visible_range_m(const LidarEquation& light);

/// Overlap near the sensor if the overlap table does not define it: linear from 0 at 0.9 m to 1 at
/// 1.0 m (Hahner et al., "Fog simulation on real LiDAR point clouds in adverse weather", ICCV
/// 2021). 1 if the table defines it, i.e. begins with 0 at a positive range.
double crossover(const LidarEquation& light, double range_m);

/// S of backscatter from the air: received_signal() times the crossover.
double weather_signal(const LidarEquation& light, double backscatter, double range_m);

/// One echo of fog, rain or snow.
struct WeatherEcho {
  double range_m = 0.0;
  double signal = 0.0;                              ///< S, see LidarEquation
  ReturnSource return_source = ReturnSource::none;  ///< fog, rain or snow
};

/// Precomputed values that all beams of one shape share.
struct PreparedWeather {
  LidarEquation light;       ///< with the weather's extinction
  FogReturn fog{};           ///< for uniform fog
  VaryingFog varying_fog{};  ///< for varying fog
  DropField rain{};
  DropField snow{};
  double min_signal = 0.0;
};

/// Throws Error for fog with the wavelength 0.
PreparedWeather prepare_weather(const Weather& weather, const LidarEquation& light,
                                double wavelength_m, const BeamShape& beam, double pulse_fwhm_s);

/// Appends the echoes in front of a hard target, or all that are strong enough if the range is
/// infinite or NaN. They depend on seed, sensor, frame and beam of `key` only, not on its purpose
/// and block.
void weather_echoes(const PreparedWeather& weather, double hard_range_m, const RngKey& key,
                    std::vector<WeatherEcho>& echoes);

}  // namespace glidar
