// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glidar {

struct YamlField;

/// A value of a YAML file with its place, for files with keys of their own. It is read as scene and
/// sensor files are, within the same limits. Functions that read it throw Error with
/// file:line:column, the field, what was found and what is allowed.
class YamlValue {
 public:
  enum class Kind : std::uint8_t { none, text, list, map };

  /// The map that is the content of a file. Throws Error: bad syntax, empty, nested too deeply, too
  /// many values, several documents, not a map.
  YamlValue(const std::string& file, const std::string& content);

  [[nodiscard]] Kind kind() const;
  [[nodiscard]] const std::string& file() const;
  [[nodiscard]] const std::string& path() const;  ///< "vary.sensor.rate_hz"; empty: the whole file
  [[nodiscard]] std::string where() const;        ///< "file:line:column: path"
  [[nodiscard]] std::string description() const;  ///< what it is, for errors
  [[nodiscard]] std::string scalar() const;       ///< empty unless it is a text
  [[nodiscard]] bool is_number() const;           ///< a text without quotes that is a number
  [[nodiscard]] std::size_t position() const;     ///< bytes of the file before it
  [[nodiscard]] bool has_anchor_alias_or_tag() const;

  [[noreturn]] void reject(const std::string& found, const std::string& allowed,
                           const std::string& remedy) const;

  /// Every key with its value, in the order of the file; each key is given once.
  [[nodiscard]] std::vector<std::pair<std::string, YamlValue>> entries() const;
  /// The same of a map whose keys are all known.
  [[nodiscard]] std::vector<std::pair<std::string, YamlValue>> entries(
      const std::vector<std::string>& known) const;
  [[nodiscard]] std::vector<YamlValue> items() const;
  [[nodiscard]] double number(const NumberRule& rule) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;  ///< not empty, without zero bytes
  /// The index of the word that it is.
  [[nodiscard]] std::size_t one_of(const std::vector<std::string>& words) const;

 private:
  YamlValue(YamlField field, std::shared_ptr<const std::string> content);

  std::shared_ptr<const YamlField> field_;
  std::shared_ptr<const std::string> content_;
};

/// The content of a file with texts in the places of some of its values; all else, and the lines of
/// the others, are unchanged. Throws Error for a value that is not a text on one line, or has an
/// anchor, an alias or a tag.
std::string with_values(const std::string& content,
                        std::vector<std::pair<YamlValue, std::string>> replaced);

}  // namespace glidar
