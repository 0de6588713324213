// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/shown_numbers.hpp>

#include <glidar/math/portable.hpp>

#include <cmath>
#include <regex>

namespace glidar::app {

double rounded(double value, int decimals) {
  const double unit = power_of_ten(decimals);
  const double scaled = value * unit;
  constexpr double kAllWhole = 9007199254740992.0;  // 2^53: larger numbers have no fraction
  if (!(std::abs(scaled) < kAllWhole)) return value;
  return std::round(scaled) / unit + 0.0;  // -0 + 0 is +0
}

std::string without_negative_zeros(const std::string& text) {
  // a minus that is not within a word, before zeros that are not part of a longer number or word
  static const std::regex kSign(R"((^|\W)-(?=0[0.]*(?![\w.])))");
  return std::regex_replace(text, kSign, "$1");
}

}  // namespace glidar::app
