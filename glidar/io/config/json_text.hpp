// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library: JSON of files, parsed within bounds.

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace glidar {

/// nlohmann's library copies, compares and prints values by recursion, and takes up to a hundred
/// bytes of memory for each value.
struct JsonLimits {
  int max_depth = 64;
  std::size_t max_values = std::size_t{1} << 24U;
};

/// Parses a text; `where` is its file, and line where it has many. Throws Error when it is nested
/// too deeply or has too many values, and the parser's exception when it is no JSON.
template <class Json>
Json parse_json(const std::string& where, std::string_view text, const JsonLimits& limits = {}) {
  std::size_t values = 0;
  const auto check = [&](int depth, typename Json::parse_event_t, const Json&) {
    if (depth > limits.max_depth) {
      throw Error({where, "JSON nested too deeply",
                   "at most " + std::to_string(limits.max_depth) + " levels", ""});
    }
    if (++values > limits.max_values) {
      throw Error(
          {where, "JSON of too many values", "at most " + std::to_string(limits.max_values), ""});
    }
    return true;
  };
  return Json::parse(text, check);
}

/// A value as JSON, in an error.
template <class Json>
std::string shown_json(const Json& value) {
  constexpr std::size_t kShown = 63;  // there is room for words about it
  return excerpt(value.dump(-1, ' ', false, Json::error_handler_t::replace), kShown);
}

}  // namespace glidar
