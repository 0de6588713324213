// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

namespace glidar {

/// Beams as arrays, rows x cols, row by row: for every sensor whose pattern is known but has no
/// formula. N = rows * cols.
struct RayTable {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<Eigen::Vector3d> directions;  ///< N, any length but 0; NaN where there is no beam
  std::vector<Eigen::Vector3d> origins_m;   ///< N; empty: all zero
  /// N, rising, from 0 to below period_ns: the table is played again and again, whatever the
  /// frames. Empty: all of the table is fired at the start of each frame.
  std::vector<double> times_ns;
  std::vector<std::uint16_t> rings;  ///< N; empty: the row
  double period_ns = 0.0;            ///< from one play to the next
};

/// The table in its own grid when the window is exactly one play of it; else the shots in the
/// window in the order of time, as one row. Frame lidar_frame, boresight +x.
/// Throws Error when an array has the wrong size or a number is out of range.
Beams make_beams(const RayTable& table, const FrameInterval& window);

}  // namespace glidar
