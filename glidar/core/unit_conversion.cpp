// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/unit_conversion.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace glidar {
namespace {

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

double in_unit(double value, double unit) {
  constexpr int kDigits = 15;
  const double quotient = value / unit;
  std::array<char, 32> text{};  // sign, digits, point and exponent take 23
  const auto end = std::to_chars(text.data(), text.data() + text.size(), quotient,
                                 std::chars_format::general, kDigits)
                       .ptr;
  double rounded = quotient;
  std::from_chars(text.data(), end, rounded);
  return rounded * unit == value ? rounded : quotient;
}

std::optional<double> find_exact_in(double inside, double unit) {
  const double clean = in_unit(inside, unit);
  if (is_same(clean * unit, inside)) return clean;
  constexpr int kNeighbours = 4;  // quotient and product round once each: two would do
  double below = inside / unit;
  double above = below;
  for (int k = 0; k <= kNeighbours; ++k) {
    if (is_same(below * unit, inside)) return below;
    if (is_same(above * unit, inside)) return above;
    below = std::nextafter(below, -kInfinity);
    above = std::nextafter(above, kInfinity);
  }
  return std::nullopt;
}

double exact_in(double inside, double unit) {
  if (const std::optional<double> exact = find_exact_in(inside, unit)) return *exact;
  throw Error({.where = "sensor",
               .found = "no number times " + number_text(unit) + " is " + number_text(inside),
               .allowed = "a sensor that was read from a file, a preset or a dict"});
}

}  // namespace glidar
