// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace glidar::testing {

/// One firing in absolute time, with bit-identical directions.
using Shot = std::tuple<std::int64_t, std::uint16_t, double, double, double>;

inline void add_shots(const Beams& beams, const FrameInterval& window, std::vector<Shot>& shots) {
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Eigen::Vector3d& d = beams.directions[i];
    if (d.hasNaN()) continue;  // a channel that does not fire in this column
    shots.emplace_back(window.start_ns + beams.times_ns[i], beams.rings[i], d.x(), d.y(), d.z());
  }
}

/// Divides a time interval into parts of very different lengths; they must have the same firings as
/// the whole interval.
inline void expect_windows_join(const Optics& optics, std::int64_t from_ns, std::int64_t to_ns) {
  const auto beams_in = [&](const FrameInterval& window) {
    return std::visit([&](const auto& o) { return make_beams(o, window); }, optics);
  };
  std::vector<Shot> whole;
  add_shots(beams_in({from_ns, to_ns}), {from_ns, to_ns}, whole);
  std::vector<Shot> parts;
  constexpr std::array<std::int64_t, 6> kLengths_ns = {1, 12'345, 55'296, 7'654'321, 33'333'333, 0};
  std::int64_t start_ns = from_ns;
  for (std::size_t i = 0; start_ns < to_ns; ++i) {
    const std::int64_t length_ns = kLengths_ns.at(i % kLengths_ns.size());
    const FrameInterval window = {start_ns, std::min(start_ns + length_ns, to_ns)};
    add_shots(beams_in(window), window, parts);
    start_ns = window.end_ns;
  }
  std::sort(whole.begin(), whole.end());
  std::sort(parts.begin(), parts.end());
  EXPECT_FALSE(whole.empty());
  EXPECT_TRUE(whole == parts) << whole.size() << " shots at once, " << parts.size() << " in parts";
}

}  // namespace glidar::testing
