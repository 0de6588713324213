// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/help_text.hpp>

namespace glidar::app {

std::string wrapped(std::string_view text) {
  constexpr std::size_t kWidth = 64;  // 100 columns less those of the names
  std::string lines;
  std::size_t line_length = 0;
  while (!text.empty()) {
    const std::size_t space = text.find(' ');
    const std::string_view word = text.substr(0, space);
    text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
    const bool fits = line_length + 1 + word.size() <= kWidth;
    if (line_length > 0) lines += fits ? ' ' : '\n';
    line_length = line_length > 0 && fits ? line_length + 1 + word.size() : word.size();
    lines += word;
  }
  return lines;
}

}  // namespace glidar::app
