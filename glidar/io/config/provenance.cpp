// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/provenance.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace glidar {
namespace {

/// Whether a key is the path itself or contains it: "optics" contains "optics.elevation_deg".
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
      const bool is_text =
          field.path.empty() && (key == "source" || key == "unverified" || key == "notes");
      if (!is_text) add_entries(value, sheet);
    }
  } else if (list_of_maps) {
    for (const YamlField& item : items(field)) add_entries(item, sheet);
  } else {
    sheet.push_back({field.path, value_text(field), "", true});
  }
}

/// Keys that `source` and `unverified` name must exist: a misspelt one would be lost.
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
  // longer keys are more specific, so they are applied last
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

/// The same map; its keys are named without the keys that lead to it.
YamlField without_path(YamlField map) {
  map.path.clear();
  return map;
}

}  // namespace

std::vector<DatasheetEntry> read_entries(const YamlField& root) {
  std::vector<DatasheetEntry> sheet;
  add_entries(root, sheet);
  add_sources(root, sheet);
  mark_unverified(root, sheet);
  return sheet;
}

void check_sources(const YamlField& map) {
  const YamlField root = without_path(map);
  std::vector<DatasheetEntry> sheet;
  add_entries(root, sheet);
  add_sources(root, sheet);
}

void check_unverified(const YamlField& map) {
  const YamlField root = without_path(map);
  std::vector<DatasheetEntry> sheet;
  add_entries(root, sheet);
  mark_unverified(root, sheet);
}

}  // namespace glidar
