// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>

#include <string>

namespace glidar::testing {

/// The sensor of a preset.
inline Sensor preset(const std::string& name) {
  return load_sensor_file(find_sensor_file(name));
}

/// The preset without noise.
inline Sensor noise_free_preset(const std::string& name) {
  Sensor sensor = preset(name);
  sensor.noise.clear();
  return sensor;
}

}  // namespace glidar::testing
