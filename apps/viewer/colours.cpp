// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/colours.hpp>

#include <algorithm>

namespace glidar::app {

Colour colour_of(ColourMap map, double t) {
  constexpr double kBlue = 2.0 / 3.0;
  t = std::clamp(t, 0.0, 1.0);
  switch (map) {
    case ColourMap::rainbow:
      return hue(kBlue * (1.0 - t));
    case ColourMap::grey:
      return grey(t);
    case ColourMap::viridis:
      break;
  }
  return viridis(t);
}

}  // namespace glidar::app
