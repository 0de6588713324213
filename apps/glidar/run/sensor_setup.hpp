// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/sensor_options.hpp>
#include <glidar/sensor/sensor.hpp>

#include <string>

namespace glidar::app {

/// The sensor file or preset if given, else the camera that the flags describe, else the scene
/// file's sensor, else a camera of 256 x 256 pixels and 20 degrees; then changed by the flags for
/// limits, light, weather and returns. --ground-truth removes pulsed light and noise. Throws Error,
/// also when a frame would not fit into this machine's memory.
Sensor make_sensor(const SensorFlags& flags, const Sensor* from_scene_file);

/// The sensor of --sensor in the mode of --mode; empty: its default mode. Throws Error.
Sensor load_sensor(const std::string& name_or_path, const std::string& mode);

/// Whether the flags select a sensor or describe a camera.
bool names_sensor(const SensorFlags& flags);

}  // namespace glidar::app
