// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/fog.hpp>
#include <glidar/sensor/lidar/fog_variation.hpp>
#include <glidar/sensor/lidar/precipitation.hpp>
#include <glidar/sensor/lidar/weather.hpp>

#include <vector>

namespace glidar {

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
