// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>

#include <filesystem>
#include <string>

namespace glidar {

/// A sensor of a file: one of its variants if it is a family of sensors, in one of its modes.
struct SensorReference {
  std::filesystem::path file;
  std::string variant = {};  ///< empty: the file has no variants
  std::string mode = {};     ///< empty: the default mode
};

/// Reads a sensor from YAML (docs/sensors.md). Every error names file:line:column, the field, what
/// is allowed and the nearest known key, and the variant and mode if there are any. A family
/// without the name of a variant is an error that lists them, an unknown mode one that lists the
/// modes.
Sensor load_sensor_file(const SensorReference& reference);
/// The same from the content of the file that is given, such as with other values.
Sensor load_sensor_content(const SensorReference& reference, const std::string& content);
Sensor load_sensor_file(const std::filesystem::path& path);

/// The same from a text, YAML or JSON; files that it names count from the working folder. Errors
/// name the field. Of its modes, the default one is read.
Sensor parse_sensor(const std::string& text);

/// The same of a text without `optics`: the sensor's beams are those of the table.
Sensor parse_sensor(const std::string& text, RayTable table);

}  // namespace glidar
