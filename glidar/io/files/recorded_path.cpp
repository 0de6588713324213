// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/recorded_path.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>

#include <algorithm>
#include <cstddef>

namespace glidar {
namespace {

bool has_control_characters(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return c < 0x20U || c == 0x7FU; });
}

[[noreturn]] void refuse(const std::string& where, std::string_view key, std::string_view text,
                         const char* allowed) {
  throw Error({where, std::string(key) + ": '" + excerpt(text) + "'", allowed, "write it again"});
}

}  // namespace

void check_recorded_path(const std::string& where, std::string_view key, std::string_view path) {
  constexpr std::size_t kMaxPath_bytes = 4096;
  if (!path.empty() && path.size() <= kMaxPath_bytes && !has_control_characters(path)) return;
  refuse(where, key, path, "a path of 1 to 4096 bytes without control characters");
}

void check_recorded_argument(const std::string& where, std::string_view argument) {
  constexpr std::size_t kMaxArgument_bytes = std::size_t{1} << 17U;  // Linux' own limit
  if (argument.size() <= kMaxArgument_bytes && !has_control_characters(argument)) return;
  refuse(where, "an argument of its command", argument,
         "at most 131072 bytes without control characters");
}

}  // namespace glidar
