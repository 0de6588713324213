// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/provenance.hpp>

#include <glidar/io/files/input_file.hpp>

#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>

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

/// Entries by their keys: those that a key covers follow it.
class SheetIndex {
 public:
  explicit SheetIndex(std::vector<DatasheetEntry>& sheet) {
    for (DatasheetEntry& entry : sheet) by_key_.emplace(entry.key, &entry);
  }

  /// The entries that a key covers. Keys that `source` and `unverified` name must exist, because a
  /// misspelt one would be lost, and be named once. Throws Error.
  std::vector<DatasheetEntry*> covered(const YamlField& at, const std::string& key) {
    if (!named_.insert(key).second)
      reject(at, "'" + shown(key) + "' is named twice", "each key once", "remove one of them");
    std::vector<DatasheetEntry*> found;
    for (auto one = by_key_.lower_bound(key); one != by_key_.end() && one->first.starts_with(key);
         ++one) {
      if (covers(key, one->first)) found.push_back(one->second);
    }
    if (found.empty()) reject_unknown(at, key);
    return found;
  }

 private:
  [[noreturn]] void reject_unknown(const YamlField& at, const std::string& key) const {
    std::vector<std::string> known;
    for (const auto& [name, entry] : by_key_) known.push_back(name);
    reject(at, "'" + shown(key) + "' is no key of this file", "a key such as optics.elevation_deg",
           suggestion(key, known));
  }

  std::multimap<std::string, DatasheetEntry*> by_key_;
  std::unordered_set<std::string> named_;
};

void add_sources(const YamlField& root, std::vector<DatasheetEntry>& sheet) {
  const auto sources = find(root, "source");
  if (!sources) return;
  SheetIndex index(sheet);
  std::unordered_map<DatasheetEntry*, std::size_t> sizes;  // of the keys that gave the sources
  for (const auto& [key, value] : entries(*sources)) {
    const std::string source = text(value);
    for (DatasheetEntry* entry : index.covered(value, key)) {
      std::size_t& size = sizes[entry];
      if (key.size() < size) continue;  // longer keys are more specific
      size = key.size();
      entry->source = source;
    }
  }
}

void mark_unverified(const YamlField& root, std::vector<DatasheetEntry>& sheet) {
  const auto unverified = find(root, "unverified");
  if (!unverified) return;
  SheetIndex index(sheet);
  for (const YamlField& item : items(*unverified)) {
    for (DatasheetEntry* entry : index.covered(item, text(item))) entry->verified = false;
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
