// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the cameras of apply_calibration().

#include <glidar/sensor/sensor.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// Camchain YAML of Kalibr, of which `name` selects a camera (empty: cam0), or camera YAML of ROS,
/// for a sensor with the optics Pinhole. Throws Error with the place in the file.
void apply_camera_calibration(const std::filesystem::path& path, const std::string& name,
                              Sensor& sensor);

}  // namespace glidar
