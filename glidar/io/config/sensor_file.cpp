// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>

#include <glidar/io/config/provenance.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <optional>
#include <utility>

namespace glidar {
namespace {

Sensor read_sensor(const YamlField& field, std::optional<RayTable> table = std::nullopt) {
  SensorKeys keys;
  keys.has_table = table.has_value();
  if (table) keys.sensor.optics = *std::move(table);
  read_struct(field, keys);
  return std::move(keys.sensor);
}

}  // namespace

Sensor load_sensor_file(const std::filesystem::path& path) {
  Sensor sensor = read_sensor(read_yaml(path));
  sensor.files.push_back(path.string());
  return sensor;
}

Sensor parse_sensor(const std::string& text) {
  return read_sensor(read_yaml_text("sensor", text));
}

Sensor parse_sensor(const std::string& text, RayTable table) {
  return read_sensor(read_yaml_text("sensor", text), std::move(table));
}

Datasheet load_datasheet(const std::filesystem::path& path) {
  const YamlField root = read_yaml(path);
  return {path.stem().string(), read_sensor(root), read_entries(root)};
}

}  // namespace glidar
