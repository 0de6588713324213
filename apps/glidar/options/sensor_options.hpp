// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/io/config/sensor_options.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace glidar::app {

/// The sensor as given on the command line.
struct SensorFlags : SensorOptions {
  std::string file;
  std::optional<std::int64_t> width;
  std::optional<std::int64_t> height;
  std::optional<double> fov_deg;
  std::optional<double> fx;
  std::optional<double> fy;
  std::optional<double> cx;
  std::optional<double> cy;
  std::optional<double> near_m;
  std::optional<double> far_m;
  std::optional<double> ambient;
  std::string attenuation;  ///< empty: not given
  bool cull_back_faces = false;
  bool ground_truth = false;
};

void add_sensor_flags(CLI::App& command, SensorFlags& flags);

/// The sensor file or preset if one is given, else the camera described by the flags, else the
/// scene file's sensor, else a camera of 256 x 256 pixels and 20 degrees; then with the flags for
/// limits, light, weather and returns; without pulse light and noise if it is to be ideal. Throws
/// Error, also when a frame of it would not fit into this machine's memory.
Sensor make_sensor(const SensorFlags& flags, const Sensor* from_scene_file);

/// Whether the flags say which sensor it is, not only how it is set up.
bool names_sensor(const SensorFlags& flags);

}  // namespace glidar::app
