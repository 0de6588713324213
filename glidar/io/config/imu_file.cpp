// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/imu_file.hpp>

#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/provenance.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

namespace glidar {
namespace {

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

}  // namespace glidar
