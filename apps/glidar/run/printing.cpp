// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/printing.hpp>

namespace glidar::app {

void print_lines(std::FILE* to, std::string_view lines) {
  const std::string text = printable_lines(lines);
  std::fwrite(text.data(), 1, text.size(), to);
}

void print_message(std::string_view prefix, std::string_view message) {
  constexpr std::size_t kMaxMessage_bytes = 8192;
  print(stderr, "{}: {}\n", prefix, excerpt(message, kMaxMessage_bytes));
}

}  // namespace glidar::app
