// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_family.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/config/yaml_reader.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

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

void reject_removal(const YamlField& missing) {
  reject(missing, "no value, which removes the key, but there is none to remove",
         "a value, or null for a key of the document", "remove the line");
}

/// The base with overrides merged deeply over it: maps are merged key by key, scalars and lists are
/// replaced, null removes a key. Throws Error: either is no map, a key is given twice, or null for
/// a key that the base does not have.
YamlField merged(const YamlField& base, const YamlField& overrides) {
  const FieldTable own = table_of(base);
  const FieldTable overriding = table_of(overrides);
  YAML::Node map(YAML::NodeType::Map);
  for (const auto& pair : base.node) {
    const std::string& key = pair.first.Scalar();
    const auto other = overriding.find(key);
    if (other == overriding.end()) {
      append(map, pair.first, pair.second);
      continue;
    }
    const YamlField& value = other->second;
    if (value.node.IsNull()) continue;
    const bool are_maps = pair.second.IsMap() && value.node.IsMap();
    append(map, pair.first, are_maps ? merged(own.at(key), value).node : value.node);
  }
  for (const auto& pair : overrides.node) {
    const std::string& key = pair.first.Scalar();
    if (own.contains(key)) continue;
    if (pair.second.IsNull()) reject_removal(overriding.at(key));
    append(map, pair.first, pair.second);
  }
  return {base.file, base.path, base.mark, map};
}

/// The same map without these keys.
YamlField without_keys(const YamlField& map, const std::vector<std::string>& keys) {
  YAML::Node rest(YAML::NodeType::Map);
  for (const auto& pair : map.node) {
    const bool is_left_out = pair.first.IsScalar() &&
                             std::find(keys.begin(), keys.end(), pair.first.Scalar()) != keys.end();
    if (!is_left_out) append(rest, pair.first, pair.second);
  }
  return {map.file, map.path, map.mark, rest};
}

constexpr std::size_t kMaxNames = 1000;  // variants or modes

std::vector<std::string> key_names(const std::optional<YamlField>& map) {
  std::vector<std::string> names;
  if (!map) return names;
  if (map->node.IsMap() && map->node.size() > kMaxNames) {
    reject(*map, std::to_string(map->node.size()) + " names", "at most 1000",
           "describe other sensors in files of their own");
  }
  std::unordered_map<std::string, std::string> known;  // by their normalised names
  for (const auto& [name, value] : entries(*map)) {
    const std::string normalised = normalised_name(name);
    if (normalised.empty())
      reject(value, "'" + excerpt(name) + "'", "a name with letters or digits");
    const auto [same, is_new] = known.try_emplace(normalised, name);
    if (!is_new) {
      reject(value, "the name equals '" + excerpt(same->second) + "'",
             "names that differ by more than case, '-', '_' and spaces", "choose another name");
    }
    names.push_back(name);
  }
  return names;
}

/// The key `name` of the document, else the name of its file.
std::string sensor_text(const YamlField& document) {
  const auto name = find(document, "name");
  return name && name->node.IsScalar() ? excerpt(name->node.Scalar())
                                       : std::filesystem::path(document.file).filename().string();
}

/// The document with the overrides of a variant.
YamlField with_variant(const YamlField& root, const std::string& variant,
                       const std::vector<std::string>& names) {
  const YamlField base = without_keys(root, {"variants"});
  if (names.empty()) {
    if (variant.empty()) return base;
    throw Error({root.file, "it has no variants, but '" + excerpt(variant) + "' is requested",
                 "the file without '#" + excerpt(variant) + "'"});
  }
  const auto aliases = find(root, "aliases");
  if (aliases) reject(*aliases, "aliases of a family", "'aliases' in each of its variants");
  const std::string remedy = "choose one: '" + root.file + "#" + names.front() + "'";
  if (variant.empty()) {
    throw Error({root.file, "it is a family of sensors",
                 "one of its variants: " + comma_separated(names), remedy});
  }
  const std::string chosen = match_name(variant, names);
  if (chosen.empty()) {
    const std::string nearest = suggestion(variant, names);
    throw Error({root.file, "'" + excerpt(variant) + "' is none of its variants",
                 comma_separated(names), nearest.empty() ? remedy : nearest});
  }
  return merged(base, need(need(root, "variants"), chosen));
}

std::vector<std::string> aliases_of(const YamlField& document) {
  std::vector<std::string> aliases;
  const auto list = find(document, "aliases");
  if (!list) return aliases;
  for (const YamlField& item : items(*list)) aliases.push_back(text(item));
  return aliases;
}

/// The default mode as the modes have it.
std::string default_mode_of(const YamlField& document, const std::vector<std::string>& modes) {
  const auto given = find(document, "default_mode");
  if (!given) return "";
  if (modes.empty()) reject(*given, "given without 'modes'", "together with modes");
  return modes.at(one_of(*given, modes));
}

std::string choose_mode(const YamlField& document, const std::string& mode,
                        const FamilyMember& member) {
  if (mode.empty()) return member.default_mode;
  const std::string chosen = match_name(mode, member.modes);
  if (!chosen.empty()) return chosen;
  if (member.modes.empty()) {
    throw Error({"mode", "'" + excerpt(mode) + "', but " + sensor_text(document) + " has no modes",
                 "a sensor with modes", "leave the mode out"});
  }
  throw Error({"mode", "'" + excerpt(mode) + "' is no mode of " + sensor_text(document),
               comma_separated(member.modes), suggestion(mode, member.modes)});
}

}  // namespace

std::vector<std::string> variants_of(const YamlField& root) {
  const auto variants = find(root, "variants");
  std::vector<std::string> names = key_names(variants);
  if (variants && names.empty()) reject(*variants, content_text(*variants), "at least one variant");
  return names;
}

FamilyMember select_sensor(const YamlField& root, const std::string& variant,
                           const std::string& mode) {
  const std::vector<std::string> variants = variants_of(root);
  FamilyMember member;
  member.variant = match_name(variant, variants);
  const YamlField document = with_variant(root, variant, variants);
  const auto modes = find(document, "modes");
  with_member_name(member, [&] {
    member.aliases = aliases_of(document);
    member.modes = key_names(modes);
    member.default_mode = default_mode_of(document, member.modes);
  });
  member.mode = choose_mode(document, mode, member);
  return with_member_name(member, [&] {
    member.document = without_keys(document, {"modes", "default_mode", "aliases"});
    if (!member.mode.empty()) {
      member.document = merged(member.document, need(*modes, member.mode));
    }
    return member;
  });
}

}  // namespace glidar
