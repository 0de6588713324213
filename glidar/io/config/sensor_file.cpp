// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>

#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/sensor_yaml.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace glidar {
namespace {

/// True for the path "optics.elevation_deg" and keys that contain it, such as "optics".
bool covers(const std::string& key, const std::string& path) {
  return path == key || path.starts_with(key + ".") || path.starts_with(key + "[");
}

std::string value_text(const YamlField& field) {
  if (field.node.IsScalar()) return field.node.Scalar();
  if (!field.node.IsSequence()) return content_text(field);
  constexpr std::size_t kShown = 8;
  std::string shown;
  const std::size_t count = field.node.size();
  for (std::size_t i = 0; i < count && i < kShown; ++i) {
    if (!field.node[i].IsScalar()) return content_text(field);
    shown += (i > 0 ? ", " : "") + field.node[i].Scalar();
  }
  return count > kShown ? shown + ", ... (" + std::to_string(count) + " in all)" : shown;
}

/// The file's values, flat; a list of plain values is one entry.
void add_entries(const YamlField& field, std::vector<DatasheetEntry>& sheet) {
  const bool list_of_maps =
      field.node.IsSequence() && field.node.size() > 0 && !field.node[0].IsScalar();
  if (field.node.IsMap()) {
    for (const auto& [key, value] : entries(field)) {
      const bool is_provenance = field.path.empty() && (key == "source" || key == "unverified");
      if (!is_provenance) add_entries(value, sheet);
    }
  } else if (list_of_maps) {
    for (const YamlField& item : items(field)) add_entries(item, sheet);
  } else {
    sheet.push_back({field.path, value_text(field), "", true});
  }
}

/// Every key that `source` and `unverified` name must be there: a misspelt one would be lost.
void require_entry(const YamlField& at, const std::string& key,
                   const std::vector<DatasheetEntry>& sheet) {
  const auto covered = [&](const DatasheetEntry& entry) { return covers(key, entry.key); };
  if (std::any_of(sheet.begin(), sheet.end(), covered)) return;
  std::vector<std::string> known;
  for (const DatasheetEntry& entry : sheet) known.push_back(entry.key);
  reject(at, "'" + key + "' is no key of this file", "a key such as optics.elevation_deg",
         suggestion(key, known));
}

void set_source(const std::string& key, const std::string& source,
                std::vector<DatasheetEntry>& sheet) {
  for (DatasheetEntry& entry : sheet) {
    if (covers(key, entry.key)) entry.source = source;
  }
}

void add_sources(const YamlField& root, std::vector<DatasheetEntry>& sheet) {
  const auto sources = find(root, "source");
  if (!sources) return;
  std::vector<std::pair<std::string, std::string>> all;  // no nodes: to assign one changes the file
  for (const auto& [key, value] : entries(*sources)) {
    require_entry(value, key, sheet);
    all.emplace_back(key, text(value));
  }
  // nearer keys win: the long ones come last
  std::stable_sort(all.begin(), all.end(), [](const auto& one, const auto& other) {
    return one.first.size() < other.first.size();
  });
  for (const auto& [key, source] : all) set_source(key, source, sheet);
}

void mark_unverified(const YamlField& root, std::vector<DatasheetEntry>& sheet) {
  const auto unverified = find(root, "unverified");
  if (!unverified) return;
  for (const YamlField& item : items(*unverified)) {
    const std::string key = text(item);
    require_entry(item, key, sheet);
    for (DatasheetEntry& entry : sheet) entry.verified = entry.verified && !covers(key, entry.key);
  }
}

std::vector<DatasheetEntry> read_entries(const YamlField& root) {
  std::vector<DatasheetEntry> sheet;
  add_entries(root, sheet);
  add_sources(root, sheet);
  mark_unverified(root, sheet);
  return sheet;
}

Sensor read_sensor_with(const YamlField& field, std::optional<RayTable> table) {
  SensorKeys keys;
  keys.has_table = table.has_value();
  if (table) keys.sensor.optics = *std::move(table);
  read_struct(field, keys);
  if (std::string file = file_of(keys.optics); !file.empty()) keys.sensor.files = {file};
  if (find(field, "source") || find(field, "unverified")) {
    YamlField root = field;
    root.path.clear();  // keys count from the sensor's own map
    read_entries(root);
  }
  return std::move(keys.sensor);
}

}  // namespace

Sensor read_sensor(const YamlField& field) {
  return read_sensor_with(field, std::nullopt);
}

Sensor load_sensor_file(const std::filesystem::path& path) {
  Sensor sensor = read_sensor(read_yaml(path));
  sensor.files.push_back(path.string());
  return sensor;
}

Sensor parse_sensor(const std::string& text) {
  return read_sensor(read_yaml_text("sensor", text));
}

Sensor parse_sensor(const std::string& text, RayTable table) {
  return read_sensor_with(read_yaml_text("sensor", text), std::move(table));
}

Datasheet load_datasheet(const std::filesystem::path& path) {
  const YamlField root = read_yaml(path);
  return {path.stem().string(), read_sensor(root), read_entries(root)};
}

}  // namespace glidar
