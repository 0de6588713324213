// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/json_error.hpp>

#include <glidar/core/excerpt.hpp>

#include <algorithm>

namespace glidar {
namespace {

// Numbers of exceptions: nlohmann/json, "Exceptions".
constexpr int kFirstTypeError = 300;
constexpr int kFirstRangeError = 400;
constexpr int kMissingKey = 403;
constexpr int kWrongType = 302;

/// The text between two others; empty if it has not both.
std::string_view between(std::string_view text, std::string_view first, std::string_view last) {
  const std::size_t begin = text.find(first);
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin + first.size());
  const std::size_t end = text.find(last);
  return end == std::string_view::npos ? std::string_view() : text.substr(0, end);
}

/// A message without its number, such as "[json.exception.type_error.302] ".
std::string_view without_number(std::string_view what) {
  const std::size_t end = what.find("] ");
  return what.starts_with('[') && end != std::string_view::npos ? what.substr(end + 2) : what;
}

/// Removes the position of a value, such as "(/command/folder) ", and returns it as
/// "command.folder"; empty if there is none.
std::string take_position(std::string_view& message) {
  const std::string_view pointer = between(message, "(/", ") ");
  if (!message.starts_with("(/") || pointer.empty()) return {};
  std::string position(pointer);
  message.remove_prefix(position.size() + 4);
  std::replace(position.begin(), position.end(), '/', '.');
  return position;
}

std::string syntax_text(std::string_view message) {
  const std::string_view line = between(message, "line ", ",");
  const std::string_view column = between(message, "column ", ":");
  if (line.empty() || column.empty()) return "its text is not valid JSON";
  const bool is_one_line = line == "1";
  const std::string place =
      (is_one_line ? "" : "line " + std::string(line) + ", ") + "column " + std::string(column);
  for (const char* early : {"unexpected end of input", "missing closing quote"}) {
    if (message.find(early) != std::string_view::npos)
      return "its text ends too early, at " + place;
  }
  return "its text is not valid JSON from " + place + " on";
}

}  // namespace

bool is_json_syntax_error(int id) {
  return id < kFirstTypeError;
}

std::string json_error_text(int id, std::string_view what) {
  std::string_view message = without_number(what);
  if (is_json_syntax_error(id)) return syntax_text(message);
  const std::string position = take_position(message);
  const std::string place = position.empty() ? "" : " in '" + excerpt(position) + "'";
  if (id == kMissingKey) {
    const std::string_view key = between(message, "key '", "' not found");
    return "the key '" + excerpt(key) + "' is missing" + place;
  }
  if (id == kWrongType)
    return excerpt("a value of another type" + place + ": " + std::string(message));
  if (id < kFirstRangeError) return "values of another structure" + place;
  return excerpt((position.empty() ? "" : position + ": ") + std::string(message));
}

}  // namespace glidar
