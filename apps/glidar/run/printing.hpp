// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace glidar::app {

/// Prints lines for people. Nothing in them controls a terminal, see printable_lines().
void print_lines(std::FILE* to, std::string_view lines);

/// Prints a line to standard error: the prefix and the message, which is cut at 8 KiB, because it
/// may quote files of others.
void print_message(std::string_view prefix, std::string_view message);

/// A value of print(): texts become one printable line.
template <class Value>
decltype(auto) printable_value(const Value& value) {
  if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
    return printable_line(value);
  } else {
    return (value);
  }
}

/// As fmt::format, for print().
template <class... Values>
std::string printable_format(fmt::string_view format, const Values&... values) {
  return fmt::vformat(format, fmt::make_format_args(values...));
}

/// As fmt::print, but line ends come from the format only, because texts may be from files.
template <class... Values>
void print(std::FILE* to, fmt::format_string<Values...> format, Values&&... values) {
  print_lines(to, printable_format(fmt::string_view(format), printable_value(values)...));
}

template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
  app::print(stdout, format, std::forward<Values>(values)...);  // not fmt's
}

/// Prints JSON in ASCII; bytes that are no UTF-8 are replaced.
template <class Json>
void print_json(const Json& json) {
  print_lines(stdout, json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n");
}

}  // namespace glidar::app
