// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// One value of a sensor file and where it comes from.
struct DatasheetEntry {
  std::string key;     ///< e.g. "optics.elevation_deg"
  std::string value;   ///< as written; long lists shortened
  std::string source;  ///< empty: not stated
  bool verified = true;
};

/// A sensor with the provenance of its numbers.
struct Datasheet {
  std::string name;  ///< of the file, without folder and ending: what a preset is found by
  Sensor sensor;
  std::vector<DatasheetEntry> entries;  ///< in the order of the file
};

/// How many values of a sensor the manufacturer's documents back: data sheets, manuals, drivers and
/// factory calibrations. Names, types and kinds are no values.
struct ValueCount {
  std::size_t backed = 0;
  std::size_t total = 0;
};
ValueCount count_values(const Datasheet& sheet);
ValueCount count_values(std::span<const DatasheetEntry> entries);

/// Like load_sensor_file, with the sources that the file gives.
Datasheet load_datasheet(const std::filesystem::path& path);

/// The bundled sensor files, by name: in sensors/ of the source, in share/glidar/sensors of an
/// installation, or in the folder given by the variable GLIDAR_SENSORS.
/// Throws Error when there is no such folder.
std::vector<std::filesystem::path> preset_files();

/// The file of a sensor given by name or path: a path if it has a folder or an ending .yaml or
/// .yml, else the name of a preset, in capitals or not.
/// Throws Error naming the nearest presets.
std::filesystem::path find_sensor_file(const std::string& name_or_path);

}  // namespace glidar
