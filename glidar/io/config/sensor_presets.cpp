// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_presets.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/files/data_folder.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace glidar {
namespace {

namespace fs = std::filesystem;

bool is_yaml(const fs::path& path) {
  const std::string ending = lower_case(path.extension().string());
  return ending == ".yaml" || ending == ".yml";
}

std::string all_names(const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& file : files) names += (names.empty() ? "" : ", ") + file.stem().string();
  return names;
}

std::vector<fs::path> yaml_files(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_yaml(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());  // the order of a folder is not the same everywhere
  return files;
}

/// What a preset is, for errors.
struct PresetKind {
  const char* where;
  const char* noun;
};

fs::path find_preset_file(const std::string& name_or_path, const std::vector<fs::path>& files,
                          const PresetKind& kind) {
  const fs::path path = name_or_path;
  std::vector<std::string> names;
  for (const fs::path& file : files) {
    names.push_back(lower_case(file.stem().string()));
    if (names.back() == lower_case(name_or_path)) return file;
  }
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path;
  const std::string nearest = closest_match(lower_case(name_or_path), names);
  const auto at = std::find(names.begin(), names.end(), nearest);
  throw Error(
      {.where = kind.where,
       .found = "'" + excerpt(name_or_path) + "' is neither a file nor the name of " + kind.noun,
       .allowed = std::string(kind.noun) + " file (.yaml), or one of " + all_names(files),
       .remedy = nearest.empty()
                     ? "see 'glidar sensors'"
                     : "did you mean " +
                           files[static_cast<std::size_t>(at - names.begin())].stem().string() +
                           "?"});
}

}  // namespace

ValueCount count_values(const Datasheet& sheet) {
  return count_values(sheet.entries);
}

ValueCount count_values(std::span<const DatasheetEntry> entries) {
  ValueCount count;
  for (const DatasheetEntry& entry : entries) {
    const std::string_view key = entry.key;
    const std::string_view last = key.substr(key.rfind('.') + 1);
    // words and conventions that the sensor's documents do not know
    constexpr std::array<std::string_view, 5> kNoValues = {"name", "type", "kind", "along",
                                                           "pixel_centre"};
    if (std::find(kNoValues.begin(), kNoValues.end(), last) != kNoValues.end()) continue;
    ++count.total;
    if (entry.verified && !entry.source.empty()) ++count.backed;
  }
  return count;
}

std::vector<fs::path> preset_files() {
  return yaml_files(data_folder("sensors", "GLIDAR_SENSORS"));
}

std::vector<fs::path> imu_preset_files() {
  return yaml_files(data_folder("sensors", "GLIDAR_SENSORS") / "imu");
}

fs::path find_sensor_file(const std::string& name_or_path) {
  const fs::path path = name_or_path;
  if (path.has_parent_path() || is_yaml(path)) return path;
  return find_preset_file(name_or_path, preset_files(), {"sensor", "a sensor"});
}

fs::path find_imu_file(const std::string& name_or_path) {
  const fs::path path = name_or_path;
  if (path.has_parent_path() || is_yaml(path)) return path;
  return find_preset_file(name_or_path, imu_preset_files(), {"imu", "an IMU"});
}

}  // namespace glidar
