// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <glidar/core/field.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/math/lookup_table.hpp>

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar {

/// Throws Error when a YAML text has too many values for memory: more than 1,000,000 as written
/// (yaml-cpp takes some 500 bytes for each), or, with its aliases expanded, more than 1,000,000 and
/// two for each byte; also when an alias is within the value that it repeats. Throws yaml-cpp's
/// exceptions when the text is no YAML.
void check_yaml_budget(const std::string& file, const std::string& text);

/// A value of a YAML file, with what an error needs to point at it.
struct YamlField {
  std::string file;
  std::string path;  ///< e.g. "models[1].pose"; empty for the whole file
  YAML::Mark mark;
  YAML::Node node;
};

inline constexpr NumberRule kCoordinate = {-kMaxCoordinate_m, kMaxCoordinate_m, false,
                                           "a number from -1e15 to 1e15"};

/// Reads a file that holds one YAML map in UTF-8. Throws Error: missing, no file, over 8 MiB, bad
/// syntax, empty, nested too deeply, too many values, several documents, not a map.
YamlField read_yaml(const std::filesystem::path& file);

/// The same of a file's content that was read before.
YamlField read_yaml_content(const std::filesystem::path& file, const std::string& content);

/// The same of a text that is no file: errors name it and the field, no line.
YamlField read_yaml_text(const std::string& name, const std::string& text);

/// "file:line:column: path", both counted from 1.
std::string where(const YamlField& field);

[[noreturn]] void reject(const YamlField& field, std::string found, std::string allowed,
                         std::string remedy = "");

/// Throws an error again from a place in this file that refers to what is wrong: `where` of the
/// error itself goes into the sentence.
[[noreturn]] void reject_at(const std::string& where, const Error& error);

/// What a field holds, for error texts: "a map", "the text 'abc'" ...
std::string content_text(const YamlField& field);

/// Whether it is a plain scalar that is a number. Quoted ones are texts.
bool is_number(const YamlField& field);

/// " did you mean ..." for a word that is none of `known`; empty when none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

/// Throws Error unless the field is a map whose keys are all among `known`, each at most once.
void require_map(const YamlField& field, const std::vector<std::string>& known);

/// Every key with its value, in the order of the file; throws Error unless it is a map without
/// duplicate keys.
std::vector<std::pair<std::string, YamlField>> entries(const YamlField& field);

/// Every element; throws Error unless it is a list.
std::vector<YamlField> items(const YamlField& field);

/// The value of a key of a map, if the key is there.
std::optional<YamlField> find(const YamlField& map, std::string_view key);

/// The value of a key that must be there.
YamlField need(const YamlField& map, std::string_view key);

double number(const YamlField& field, const NumberRule& rule);
/// A whole number from min to max.
std::uint32_t whole_number(const YamlField& field, std::uint32_t min, std::uint32_t max);
bool boolean(const YamlField& field);
/// Any scalar but an empty one.
std::string text(const YamlField& field);
/// A path, seen from the file's own folder. "..", also behind a symbolic link, means what it means
/// to the system.
std::string path_beside(const YamlField& field);
/// The place of the text in `words`; throws Error when it is none of them.
std::size_t one_of(const YamlField& field, const std::vector<std::string>& words);
/// A list of 1 to 4096 pairs [place, value] with rising places, which are in `unit`.
LookupTable table(const YamlField& field, const NumberRule& place, const NumberRule& value,
                  double unit = 1.0);
/// A list of three numbers.
Eigen::Vector3d triple(const YamlField& field, const NumberRule& rule);

}  // namespace glidar
