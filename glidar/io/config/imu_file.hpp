// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/sensor/imu.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// Reads an IMU from YAML (docs/imu.md). Every error names file:line:column, the field, what is
/// allowed and the nearest known key.
Imu load_imu_file(const std::filesystem::path& path);

/// The same from a text, YAML or JSON. Errors name the field.
Imu parse_imu(const std::string& text);

/// All numbers of an IMU as a JSON text: parse_imu() makes the same IMU from it, to the last bit.
/// Throws Error naming the key when no number in the file's unit gives a number of the IMU.
std::string imu_document(const Imu& imu);

/// An IMU with the provenance of its numbers.
struct ImuDatasheet {
  std::string name;  ///< of the file, without folder and ending
  Imu imu;
  std::vector<DatasheetEntry> entries;  ///< in the order of the file
};

ImuDatasheet load_imu_datasheet(const std::filesystem::path& path);

/// The bundled IMU files, by name: those in the folder imu of that of the sensor presets.
std::vector<std::filesystem::path> imu_preset_files();

/// The file of an IMU given by name or path, as find_sensor_file().
std::filesystem::path find_imu_file(const std::string& name_or_path);

}  // namespace glidar
