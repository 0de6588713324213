// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// Reads a sensor from YAML (docs/files.md). Every error names file:line:column, the field, what is
/// allowed and the nearest known key.
Sensor load_sensor_file(const std::filesystem::path& path);

/// The same from a text, YAML or JSON; files that it names count from the working folder. Errors
/// name the field.
Sensor parse_sensor(const std::string& text);

/// The same of a text without `optics`: the sensor's beams are those of the table.
Sensor parse_sensor(const std::string& text, RayTable table);

}  // namespace glidar
