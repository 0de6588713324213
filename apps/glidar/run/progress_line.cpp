// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/progress_line.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

std::string duration_text(double seconds) {
  constexpr double kLongest_s = 359'999.0;  // 99 h 59 min 59 s
  const auto s = static_cast<int>(std::ceil(std::min(seconds, kLongest_s)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

/// The bar, percent and remaining time.
std::string bar_text(double fraction, double elapsed_s) {
  constexpr int kBarWidth = 30;
  const auto filled = static_cast<int>(fraction * kBarWidth);
  std::string text = fmt::format(" [{:#<{}}{:.<{}}] {:3.0f} %", "", filled, "", kBarWidth - filled,
                                 std::floor(100.0 * fraction));
  if (fraction > 0.0) {
    text += fmt::format(", {} left", duration_text(elapsed_s * (1.0 - fraction) / fraction));
  }
  return text;
}

}  // namespace

std::string progress_line(std::string_view task, double fraction_done, double elapsed_s,
                          std::size_t columns) {
  const std::string tail = fraction_done < 0.0
                               ? fmt::format(" ... {}", duration_text(std::floor(elapsed_s)))
                               : bar_text(std::min(fraction_done, 1.0), elapsed_s);
  const std::size_t room = columns > tail.size() ? columns - tail.size() : 0;  // for the name
  return (std::string(task.substr(0, room)) + tail).substr(0, columns);
}

}  // namespace glidar::app
