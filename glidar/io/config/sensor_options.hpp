// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/noise/noise.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// A step of noise as its name and numbers in a sensor file: "range_gaussian sigma_m 0.03,
/// sigma_per_m 0".
std::string noise_text(const NoiseStep& step);

/// Changes to a sensor that users request by option. An empty value keeps what the sensor has.
struct SensorOptions {
  std::vector<std::string> calibration_files;    ///< of a spinning sensor, see apply_calibration()
  std::optional<double> rate_hz;                 ///< see set_rate()
  std::optional<std::int64_t> columns_per_turn;  ///< of a spinning sensor, 1 to 1048576
  std::optional<DepthModel> depth_model;         ///< of a sensor with a depth_camera
  std::vector<Return> returns;                   ///< of a sensor with pulsed light, 1 to 16
  std::optional<double> visibility_m;            ///< 0: no fog, up to 1e6; for pulsed light
  std::optional<double> rain_mm_per_h;           ///< 0 to 1000; for pulsed light
  std::optional<double> snow_mm_per_h;           ///< of melted water, 0 to 1000; for pulsed light
};

/// What the user calls the options; errors name them so.
struct SensorOptionNames {
  std::string rate = "rate_hz";
  std::string columns_per_turn = "columns_per_turn";
  std::string depth_model = "depth_model";
  std::string returns = "returns";
  std::string visibility = "visibility_m";
  std::string rain = "rain_mm_per_h";
  std::string snow = "snow_mm_per_h";
};

/// Returns by name ("strongest", "last" ...), or a single number: how many of the nearest.
/// Throws Error naming `option`: an unknown name, with the nearest known one, or too many.
std::vector<Return> parse_returns(const std::string& option, const std::vector<std::string>& words);

/// "law" or "physical". Throws Error naming `option`.
DepthModel depth_model_named(const std::string& option, const std::string& name);

/// Each throws Error naming the option when a value is out of range or the sensor has no such
/// property.
void apply_calibrations(const SensorOptions& options, Sensor& sensor);
void apply_scan(const SensorOptions& options, const SensorOptionNames& names, Sensor& sensor);
void apply_depth_model(const SensorOptions& options, const SensorOptionNames& names,
                       Sensor& sensor);
void apply_weather(const SensorOptions& options, const SensorOptionNames& names, Sensor& sensor);
void apply_returns(const SensorOptions& options, const SensorOptionNames& names, Sensor& sensor);

}  // namespace glidar
