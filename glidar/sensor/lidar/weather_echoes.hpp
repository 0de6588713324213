// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/fog.hpp>
#include <glidar/sensor/lidar/fog_variation.hpp>
#include <glidar/sensor/lidar/precipitation.hpp>
#include <glidar/sensor/lidar/weather.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// What the air itself sends back to a beam.
struct WeatherEcho {
  double range_m = 0.0;
  double signal = 0.0;                              ///< S as of LidarEquation
  ReturnSource return_source = ReturnSource::none;  ///< fog, rain or snow
};

/// Weather as a light meets it: all that is the same for beams of one shape.
struct PreparedWeather {
  LidarEquation light;       ///< with the weather's extinction
  FogReturn fog{};           ///< when it does not vary
  VaryingFog varying_fog{};  ///< when it does
  DropField rain{};
  DropField snow{};
  double min_signal = 0.0;
};

/// Throws Error when there is fog and the wavelength is 0.
PreparedWeather prepare_weather(const Weather& weather, const LidarEquation& light,
                                double wavelength_m, const BeamShape& beam, double pulse_fwhm_s);

/// Appends the echoes before a hard target, or to where they are too faint for a range that is
/// infinite or NaN. A function of seed, sensor, frame and beam alone; the draw's purpose and block
/// do not matter.
void weather_echoes(const PreparedWeather& weather, double hard_range_m, const RngKey& draw,
                    std::vector<WeatherEcho>& echoes);

}  // namespace glidar
