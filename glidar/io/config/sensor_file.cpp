// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>

#include <glidar/io/config/provenance.hpp>
#include <glidar/io/config/sensor_family.hpp>
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

/// A sensor of a family, or of a file without variants and modes.
Sensor read_member(const FamilyMember& member, std::optional<RayTable> table = std::nullopt) {
  return with_member_name(member, [&] {
    Sensor sensor = read_sensor(member.document, std::move(table));
    sensor.variant = member.variant;
    sensor.mode = member.mode;
    return sensor;
  });
}

/// The sensor of a file with this content.
Sensor load_sensor(const YamlField& root, const SensorReference& reference) {
  Sensor sensor = read_member(select_sensor(root, reference.variant, reference.mode));
  sensor.files.push_back(reference.file.string());
  return sensor;
}

}  // namespace

Sensor load_sensor_file(const SensorReference& reference) {
  return load_sensor(read_yaml(reference.file), reference);
}

Sensor load_sensor_content(const SensorReference& reference, const std::string& content) {
  return load_sensor(read_yaml_content(reference.file, content), reference);
}

Sensor load_sensor_file(const std::filesystem::path& path) {
  return load_sensor_file(SensorReference{.file = path});
}

Sensor parse_sensor(const std::string& text) {
  return read_member(select_sensor(read_yaml_text("sensor", text), "", ""));
}

Sensor parse_sensor(const std::string& text, RayTable table) {
  return read_member(select_sensor(read_yaml_text("sensor", text), "", ""), std::move(table));
}

Datasheet load_datasheet(const SensorReference& reference) {
  const YamlField root = read_yaml(reference.file);
  const FamilyMember member = select_sensor(root, reference.variant, reference.mode);
  Sensor sensor = read_member(member);
  sensor.files.push_back(reference.file.string());
  return {.name = member.variant.empty() ? reference.file.stem().string() : member.variant,
          .sensor = std::move(sensor),
          .entries = with_member_name(member, [&] { return read_entries(member.document); }),
          .aliases = member.aliases,
          .modes = member.modes,
          .default_mode = member.default_mode};
}

}  // namespace glidar
