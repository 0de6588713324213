// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/exact_unit.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_numbers.hpp>
#include <glidar/math/constants.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

namespace glidar {
namespace {

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

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
               .allowed = "a sensor that was read from a file, a preset or a dict",
               .remedy = ""});
}

}  // namespace glidar
