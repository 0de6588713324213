// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_presets.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/sensor_family.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/files/paths.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace glidar {

namespace fs = std::filesystem;

std::string normalised_name(std::string_view name) {
  std::string normalised = lower_case(name);
  std::erase_if(normalised, [](char c) { return c == '-' || c == '_' || c == ' '; });
  return normalised;
}

std::string match_name(const std::string& name, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  const std::string wanted = normalised_name(name);
  const auto at = std::find_if(names.begin(), names.end(), [&](const std::string& candidate) {
    return normalised_name(candidate) == wanted;
  });
  return at == names.end() ? "" : *at;
}

std::string nearest_names(const std::string& name, std::vector<std::string> names,
                          const std::string& otherwise) {
  constexpr std::size_t kMaxNames = 3;
  std::vector<std::string> nearest;
  while (nearest.size() < kMaxNames) {
    const std::string next = closest_match(name, names);
    if (next.empty()) break;
    nearest.push_back(next);
    std::erase(names, next);
  }
  if (nearest.empty()) return otherwise;
  std::string text = "did you mean " + nearest.front();
  for (std::size_t i = 1; i < nearest.size(); ++i) {
    text += (i + 1 < nearest.size() ? ", " : " or ") + nearest[i];
  }
  return text + "?";
}

bool is_yaml(const fs::path& path) {
  const std::string ending = lower_case(path.extension().string());
  return ending == ".yaml" || ending == ".yml";
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

namespace {

std::vector<fs::path> sensor_files() {
  return yaml_files(sensor_folder());
}

SensorPreset preset_of(const YamlField& root, const std::string& variant) {
  const FamilyMember member = select_sensor(root, variant, "");
  const auto title = find(member.document, "name");
  const fs::path file = root.file;
  return {.name = variant.empty() ? file.stem().string() : variant,
          .title = title ? text(*title) : "",
          .reference = {.file = file, .variant = variant},
          .aliases = member.aliases,
          .modes = member.modes,
          .default_mode = member.default_mode};
}

void add_presets(const fs::path& file, std::vector<SensorPreset>& presets) {
  const YamlField root = read_yaml(file);
  const std::vector<std::string> variants = variants_of(root);
  if (variants.empty()) presets.push_back(preset_of(root, ""));
  for (const std::string& variant : variants) presets.push_back(preset_of(root, variant));
}

/// Whether a file may define a sensor of this normalised name. To parse all files takes a hundred
/// times as long.
bool may_define(const fs::path& file, const std::string& normalised) {
  if (normalised_name(file.stem().string()) == normalised) return true;
  const std::string content = read_text_file(file, {"a sensor file", 8, ""});
  return normalised_name(content).find(normalised) != std::string::npos;
}

/// The presets of the files that may define a sensor of this name.
std::vector<SensorPreset> presets_that_may_be(const std::string& name) {
  std::vector<SensorPreset> presets;
  const std::string normalised = normalised_name(name);
  for (const fs::path& file : sensor_files()) {
    if (!normalised.empty() && may_define(file, normalised)) add_presets(file, presets);
  }
  return presets;
}

const SensorPreset* find_by(const std::vector<SensorPreset>& presets,
                            bool (*is_equal)(const SensorPreset&, const std::string&),
                            const std::string& name) {
  const auto at = std::find_if(presets.begin(), presets.end(),
                               [&](const SensorPreset& one) { return is_equal(one, name); });
  return at == presets.end() ? nullptr : &*at;
}

bool has_name(const SensorPreset& preset, const std::string& name) {
  return preset.name == name;
}

bool has_normalised_name(const SensorPreset& preset, const std::string& name) {
  return normalised_name(preset.name) == normalised_name(name);
}

bool has_alias(const SensorPreset& preset, const std::string& name) {
  return !match_name(name, preset.aliases).empty();
}

/// What to write for the sensor of a family whose file has this name; empty: there is none.
std::string family_text(const std::string& name) {
  for (const fs::path& file : sensor_files()) {
    if (normalised_name(file.stem().string()) != normalised_name(name)) continue;
    const std::vector<std::string> variants = variants_of(read_yaml(file));
    return "it is a family of sensors: " + comma_separated(variants);
  }
  return "";
}

[[noreturn]] void reject_name(const std::string& name) {
  const std::string family = family_text(name);
  if (!family.empty()) {
    throw Error({"sensor", "'" + excerpt(name) + "' is no sensor", "", family});
  }
  std::vector<std::string> names;
  for (const SensorPreset& preset : sensor_presets()) {
    names.push_back(preset.name);
    names.insert(names.end(), preset.aliases.begin(), preset.aliases.end());
  }
  throw Error({.where = "sensor",
               .found = "'" + excerpt(name) + "' is neither a file nor the name of a sensor",
               .allowed = "a sensor file (.yaml), or a name that 'glidar sensors' lists",
               .remedy = nearest_names(name, names, "see 'glidar sensors'")});
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

fs::path sensor_folder() {
  return data_folder("sensors", "GLIDAR_SENSORS");
}

std::vector<SensorPreset> sensor_presets() {
  std::vector<SensorPreset> presets;
  for (const fs::path& file : sensor_files()) add_presets(file, presets);
  std::sort(presets.begin(), presets.end(),
            [](const auto& one, const auto& other) { return one.name < other.name; });
  return presets;
}

std::vector<SensorPreset> matching_presets(const std::string& text) {
  const std::string wanted = normalised_name(text);
  const auto contains = [&](const std::string& name) {
    return normalised_name(name).find(wanted) != std::string::npos;
  };
  std::vector<SensorPreset> presets = sensor_presets();
  std::erase_if(presets, [&](const SensorPreset& one) {
    return !contains(one.name) && !contains(one.title) &&
           std::none_of(one.aliases.begin(), one.aliases.end(), contains);
  });
  return presets;
}

std::optional<SensorPreset> preset_named(const std::string& name) {
  const std::vector<SensorPreset> presets = presets_that_may_be(name);
  for (const auto is_equal : {has_name, has_normalised_name, has_alias}) {
    if (const SensorPreset* preset = find_by(presets, is_equal, name)) return *preset;
  }
  return std::nullopt;
}

SensorReference split_variant(const std::string& path) {
  const std::size_t at = path.rfind('#');
  std::error_code error;
  if (at == std::string::npos || fs::is_regular_file(path, error)) return {.file = path};
  SensorReference reference{.file = path.substr(0, at), .variant = path.substr(at + 1)};
  const fs::path& file = reference.file;
  if (!is_yaml(file) && !fs::is_regular_file(file, error)) return {.file = path};
  if (!reference.variant.empty()) return reference;
  throw Error({"sensor", "'" + excerpt(path) + "' has no variant after '#'", "FILE#VARIANT",
               "add the name of a variant"});
}

SensorReference find_sensor_file(const std::string& name_or_path, const std::string& mode) {
  SensorReference reference = split_variant(name_or_path);
  reference.mode = mode;
  const fs::path& path = reference.file;
  const bool is_path = path.has_parent_path() || is_yaml(path) || !reference.variant.empty();
  if (is_path) return reference;
  if (const auto preset = preset_named(name_or_path)) {
    return {preset->reference.file, preset->reference.variant, mode};
  }
  std::error_code error;
  if (fs::is_regular_file(path, error)) return reference;
  reject_name(name_or_path);
}

}  // namespace glidar
