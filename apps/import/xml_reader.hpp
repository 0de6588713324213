// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/text_source.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace glidar::import {

/// A piece of an XML text.
struct XmlEvent {
  enum class Kind : std::uint8_t { start, end, text, finished };
  Kind kind = Kind::finished;
  std::string name;  ///< of the element, without the prefix of its namespace
  std::map<std::string, std::string> attributes;  ///< of a start, as written
  std::string text;                               ///< as written
};

/// A pull parser for the elements of an XML text (W3C XML 1.0). Skips comments, declarations and
/// instructions, and keeps entities as written. It is for texts that the importer accepts; for
/// others the elements are unspecified.
class XmlReader {
 public:
  explicit XmlReader(TextSource source) : source_(std::move(source)) {}

  /// An element without content has a start and an end.
  XmlEvent next();

 private:
  bool load();
  bool starts_with(std::string_view prefix);
  std::size_t find(std::string_view text, std::size_t from);
  std::size_t find_tag_end();
  std::string take(std::size_t end);
  void skip_past(std::string_view text);
  void skip_doctype();
  bool skip_markup();
  XmlEvent text_event();
  XmlEvent tag_event();

  TextSource source_;
  std::string text_;  ///< the loaded text
  std::size_t at_ = 0;
  std::string empty_element_;  ///< its end event is next
};

/// The text without leading and trailing XML white space.
std::string trimmed(const std::string& text);

}  // namespace glidar::import
