// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/yaml_merge.hpp>

#include <algorithm>
#include <unordered_map>

namespace glidar {
namespace {

using FieldTable = std::unordered_map<std::string, YamlField>;

/// The values of a map by their keys. Rejects what is no map, and keys that are given twice.
FieldTable table_of(const YamlField& map) {
  FieldTable table;
  for (auto& [key, value] : entries(map)) table.emplace(key, value);
  return table;
}

/// Appends a key with its place in the file. force_insert() shares nodes, and assigning one would
/// change the document.
void append(YAML::Node& map, const YAML::Node& key, const YAML::Node& value) {
  map.force_insert(key, value);
}

YAML::Node merged_value(const YamlField& base, const YamlField& overriding) {
  const bool are_maps = base.node.IsMap() && overriding.node.IsMap();
  return are_maps ? merged(base, overriding).node : overriding.node;
}

void reject_removal(const YamlField& missing) {
  reject(missing, "no value, which removes the key, but there is none to remove",
         "a value, or null for a key of the document", "remove the line");
}

}  // namespace

YamlField merged(const YamlField& base, const YamlField& overrides) {
  const FieldTable own = table_of(base);
  const FieldTable overriding = table_of(overrides);
  YAML::Node map(YAML::NodeType::Map);
  for (const auto& pair : base.node) {
    const std::string& key = pair.first.Scalar();
    const auto other = overriding.find(key);
    const bool is_overridden = other != overriding.end();
    if (is_overridden && other->second.node.IsNull()) continue;
    append(map, pair.first, is_overridden ? merged_value(own.at(key), other->second) : pair.second);
  }
  for (const auto& pair : overrides.node) {
    const std::string& key = pair.first.Scalar();
    if (own.contains(key)) continue;
    if (pair.second.IsNull()) reject_removal(overriding.at(key));
    append(map, pair.first, pair.second);
  }
  return {base.file, base.path, base.mark, map};
}

YamlField without_keys(const YamlField& map, const std::vector<std::string>& keys) {
  YAML::Node rest(YAML::NodeType::Map);
  for (const auto& pair : map.node) {
    const bool is_left_out = pair.first.IsScalar() &&
                             std::find(keys.begin(), keys.end(), pair.first.Scalar()) != keys.end();
    if (!is_left_out) append(rest, pair.first, pair.second);
  }
  return {map.file, map.path, map.mark, rest};
}

}  // namespace glidar
