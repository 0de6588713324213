// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>
#include <glidar/sensor/sensor.hpp>

#include <optional>
#include <vector>

namespace glidar {

/// True when a beam of this sensor is more than one ray with one return: it has a footprint,
/// reports several returns or another than the strongest, has range walk, or meets mirrors or
/// weather.
bool needs_waveform(const Sensor& sensor, const Scene& scene);

/// The footprint and attenuation of a sensor's pulses.
struct PulseModel {
  std::vector<SubRay> sub_rays;            ///< of each beam; without a footprint a single one
  std::optional<PreparedWeather> weather;  ///< empty: clear air
  LidarEquation lidar_equation;            ///< with the weather's extinction
  bool has_mirrors = false;                ///< whether the scene has mirrors
};

/// A sensor with everything about it that is the same for all frames of a scene.
struct PreparedSensor {
  const Sensor& sensor;
  NoisePlan noise;
  HitColumnMask required_hit_columns;     ///< ground truth that signal, occlusion and noise read
  std::optional<PulseModel> pulse_model;  ///< set when needs_waveform()
};

/// Throws Error when the sensor's weather needs what the sensor lacks, see check_weather(). Refers
/// to the sensor.
PreparedSensor prepare_sensor(const Sensor& sensor, const Scene& scene);

}  // namespace glidar
