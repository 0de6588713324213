// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

namespace glidar {

/// Beams as arrays, rows x cols, row-major, for sensors whose pattern is known but has no formula.
/// N = rows * cols. Sensor frame, metres.
struct RayTable {
  static constexpr TypeInfo kType = {"table", "any list of rays from a file"};
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<Eigen::Vector3d> directions;  ///< N, any length except 0; NaN: no beam
  std::vector<Eigen::Vector3d> origins_m;   ///< N; empty: all zero
  /// N, increasing, in [0, period_ns): the table repeats independently of the frames. Empty: all
  /// beams are fired at the start of each frame.
  std::vector<double> times_ns;
  std::vector<std::uint16_t> rings;  ///< N; empty: the row
  double period_ns = 0.0;            ///< period of the repetition
};

/// The table in its own grid if the interval is exactly one period; else the firings in the
/// interval in time order, as one row. Frame lidar_frame (x forward, y left, z up), boresight +x.
/// Throws Error if an array has the wrong size or a number is out of range.
Beams make_beams(const RayTable& table, const FrameInterval& interval);

}  // namespace glidar
