// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/imu_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/provenance.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <system_error>

namespace glidar {
namespace {

namespace fs = std::filesystem;

Imu read_imu(const YamlField& root) {
  Imu imu;
  read_struct(root, imu);
  return imu;
}

}  // namespace

Imu load_imu_file(const std::filesystem::path& path) {
  return read_imu(read_yaml(path));
}

Imu parse_imu(const std::string& text) {
  return read_imu(read_yaml_text("imu", text));
}

std::string imu_document(const Imu& imu) {
  return write_struct(FieldVisitor::Mode::document, imu).dump();
}

ImuDatasheet load_imu_datasheet(const std::filesystem::path& path) {
  const YamlField root = read_yaml(path);
  return {path.stem().string(), read_imu(root), read_entries(root)};
}

std::vector<fs::path> imu_preset_files() {
  return yaml_files(sensor_folder() / "imu");
}

fs::path find_imu_file(const std::string& name_or_path) {
  const fs::path path = name_or_path;
  if (path.has_parent_path() || is_yaml(path)) return path;
  std::vector<std::string> names;
  for (const fs::path& file : imu_preset_files()) {
    names.push_back(file.stem().string());
    if (normalised_name(names.back()) == normalised_name(name_or_path)) return file;
  }
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path;
  throw Error({.where = "imu",
               .found = "'" + excerpt(name_or_path) + "' is neither a file nor the name of an IMU",
               .allowed = "an IMU file (.yaml), or one of " + comma_separated(names),
               .remedy = nearest_names(name_or_path, names, "see 'glidar sensors --imus'")});
}

}  // namespace glidar
