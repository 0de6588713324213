// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/shown_numbers.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glidar::app {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";

bool is_one_of(char c, std::string_view characters) {
  return characters.find(c) != std::string_view::npos;
}

/// Whether the text begins with a zero number that is not part of a longer word.
bool begins_with_zero(std::string_view text) {
  const std::size_t end = std::min(text.find_first_not_of("0."), text.size());
  if (end == 0 || text.front() != '0') return false;
  return end == text.size() || !(is_one_of(text[end], kDigits) || is_one_of(text[end], kLetters));
}

}  // namespace

double rounded(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  const double scaled = value * unit;
  constexpr double kAllWhole = 9007199254740992.0;  // 2^53: larger numbers have no fraction
  if (!(std::abs(scaled) < kAllWhole)) return value;
  return std::round(scaled) / unit + 0.0;  // -0 + 0 is +0
}

std::string without_negative_zeros(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_sign =
        text[i] == '-' &&
        (i == 0 || !(is_one_of(text[i - 1], kDigits) || is_one_of(text[i - 1], kLetters)));
    if (!is_sign || !begins_with_zero(text.substr(i + 1))) result += text[i];
  }
  return result;
}

}  // namespace glidar::app
