// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/weather_signal.hpp>

#include <algorithm>

namespace glidar {
namespace {

constexpr double kBlindRange_m = 0.9;
constexpr double kFullOverlap_m = 1.0;

bool defines_near_range(const LidarEquation& light) {
  if (light.overlap.empty()) return false;
  const auto [range_m, share] = light.overlap.front();
  return range_m > 0.0 && share == 0.0;
}

}  // namespace

double min_visible_range_m(const LidarEquation& light) {
  return defines_near_range(light) ? light.overlap.front()[0] : kBlindRange_m;
}

double crossover(const LidarEquation& light, double range_m) {
  if (defines_near_range(light)) return 1.0;
  return std::clamp((range_m - kBlindRange_m) / (kFullOverlap_m - kBlindRange_m), 0.0, 1.0);
}

double weather_signal(const LidarEquation& light, double backscatter, double range_m) {
  return received_signal(light, backscatter, range_m) * crossover(light, range_m);
}

}  // namespace glidar
