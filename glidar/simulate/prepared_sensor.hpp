// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>
#include <glidar/sensor/sensor.hpp>
#include <glidar/simulate/prepared_active_stereo.hpp>
#include <glidar/simulate/prepared_structured_light.hpp>
#include <glidar/simulate/prepared_tof.hpp>

#include <optional>
#include <variant>
#include <vector>

namespace glidar {

/// True when a beam of this sensor is more than one ray with one return: it has a footprint,
/// reports several returns or another than the strongest, has range walk, or meets mirrors or
/// weather.
bool needs_waveform(const Sensor& sensor, bool has_mirrors);

/// The footprint and attenuation of a sensor's pulses.
struct PulseModel {
  std::vector<SubRay> sub_rays;            ///< of each beam; without a footprint a single one
  std::optional<PreparedWeather> weather;  ///< empty: clear air
  LidarEquation lidar_equation;            ///< with the weather's extinction
  bool has_mirrors = false;                ///< whether the sensor may see mirrors
};

/// A depth camera that is simulated from its raw images.
using PreparedDepthCamera =
    std::variant<PreparedActiveStereo, PreparedTof, PreparedStructuredLight>;

/// A sensor with everything about it that is the same for all frames of a scene.
struct PreparedSensor {
  const Sensor& sensor;
  NoisePlan noise;                        ///< without steps for a depth camera
  HitColumnMask required_hit_columns;     ///< ground truth that signal, occlusion and noise read
  std::optional<PulseModel> pulse_model;  ///< set when needs_waveform()
  std::optional<PreparedDepthCamera> depth_camera;  ///< set for DepthModel::physical
};

/// Throws Error when the sensor's weather, radial velocities or depth camera need what the sensor
/// lacks, see check_weather(), check_doppler() and check_depth_camera(). Refers to the sensor.
PreparedSensor prepare_sensor(const Sensor& sensor, bool has_mirrors);

}  // namespace glidar
