// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/sector_table.hpp>

#include <algorithm>
#include <vector>

// Helpers of all grids for filling a GridView.
namespace glidar::scan_raster {

/// Rounding error of the kernels, columns or rows.
inline constexpr double kCellMargin = 2e-3;
/// Added to measured deviations on each side, columns or rows.
inline constexpr double kDeviationMargin = 1e-3;
/// Maximum span of deviations, columns or rows: rows or sectors beyond it are not in the grid.
inline constexpr double kMaxSpread = 4.0;

inline void set_shape(const SectorShape& shape, GridView& view) {
  view.rows = shape.rows;
  view.columns = shape.columns;
  view.pitch = shape.pitch();
  view.tile_pitch = shape.tile_pitch();
}

/// Sets the bounds of the deviations, one per row.
inline void set_deviations(const std::vector<float>& low, const std::vector<float>& high,
                           GridView& view) {
  view.low_deviation = low.data();
  view.high_deviation = high.data();
  view.min_deviation = *std::min_element(low.begin(), low.end());
  view.max_deviation = *std::max_element(high.begin(), high.end());
}

}  // namespace glidar::scan_raster
