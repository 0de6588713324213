// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/imu_list.hpp>

#include <apps/glidar/run/printing.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/math/constants.hpp>

#include <nlohmann/json.hpp>

namespace glidar::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMicroG_m_s2 = 1e-6 * kStandardGravity_m_s2;

void print_imu_heading() {
  print("{:<12} {:>7} {:>15} {:>15} {:>10} {:>10} {:>9} {:>6}  {}\n", "name", "rate", "gyro noise",
        "accel noise", "gyro bias", "accel bias", "range", "range", "backed");
  print("{:<12} {:>7} {:>15} {:>15} {:>10} {:>10} {:>9} {:>6}\n", "", "Hz", "deg/s/sqrt(Hz)",
        "ug/sqrt(Hz)", "deg/h", "ug", "deg/s", "g");
}

void print_row(const ImuDatasheet& sheet) {
  const Imu& imu = sheet.imu;
  const ValueCount values = count_values(sheet.entries);
  print("{:<12} {:>7g} {:>15.4g} {:>15.4g} {:>10.4g} {:>10.4g} {:>9.4g} {:>6.4g}  {} of {}\n",
        sheet.name, imu.rate_hz, imu.gyroscope.noise_density * kDegreesPerRadian,
        imu.accelerometer.noise_density / kMicroG_m_s2,
        imu.gyroscope.bias_instability * kDegreesPerRadian * 3600.0,
        imu.accelerometer.bias_instability / kMicroG_m_s2, imu.gyroscope.range * kDegreesPerRadian,
        imu.accelerometer.range / kStandardGravity_m_s2, values.backed, values.total);
}

Json json_of(const ImuDatasheet& sheet) {
  const ValueCount values = count_values(sheet.entries);
  return {{"name", sheet.name},
          {"imu", Json::parse(imu_document(sheet.imu))},
          {"values", values.total},
          {"backed", values.backed}};
}

void print_imu_json(const Json& json) {
  print_json(json);
}

}  // namespace

void list_imus(bool as_json) {
  Json json = Json::array();
  if (!as_json) print_imu_heading();
  for (const std::filesystem::path& file : imu_preset_files()) {
    const ImuDatasheet sheet = load_imu_datasheet(file);
    if (as_json) {
      json.push_back(json_of(sheet));
    } else {
      print_row(sheet);
    }
  }
  if (as_json) print_imu_json(json);
}

std::optional<std::filesystem::path> imu_preset_named(const std::string& name) {
  for (const std::filesystem::path& file : imu_preset_files()) {
    if (lower_case(file.stem().string()) == lower_case(name)) return file;
  }
  return std::nullopt;
}

void print_imu(const std::filesystem::path& file, bool as_json) {
  const ImuDatasheet sheet = load_imu_datasheet(file);
  if (as_json) return print_imu_json(json_of(sheet));
  print("{}\n\n", sheet.imu.name);
  print_imu_heading();
  print_row(sheet);
  print("\n");
  for (const DatasheetEntry& entry : sheet.entries) {
    print("{}{} = {}\n", entry.verified ? "  " : "* ", entry.key, entry.value);
    if (!entry.source.empty()) print("      {}\n", entry.source);
  }
  print("\n* without a source in the manufacturer's documents\n");
}

}  // namespace glidar::app
