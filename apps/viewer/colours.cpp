// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/colours.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

std::uint8_t level(double t) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(t, 0.0, 1.0)));
}

}  // namespace

Colour hue(double turn) {
  const double sixth = 6.0 * (turn - std::floor(turn));
  return {level(std::abs(sixth - 3.0) - 1.0), level(2.0 - std::abs(sixth - 2.0)),
          level(2.0 - std::abs(sixth - 4.0))};
}

Colour colour_of(ColourMap map, double t) {
  constexpr double kBlue = 2.0 / 3.0;
  t = std::clamp(t, 0.0, 1.0);
  switch (map) {
    case ColourMap::rainbow:
      return hue(kBlue * (1.0 - t));
    case ColourMap::grey:
      return {level(t), level(t), level(t)};
    case ColourMap::viridis:
      break;
  }
  return viridis(t);
}

Colour colour_of_number(std::uint32_t number) {
  constexpr double kGoldenSection = 0.6180339887498949;
  constexpr double kFirst = 0.08;
  return hue(kFirst + kGoldenSection * number);
}

}  // namespace glidar::app
