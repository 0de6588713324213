// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/render/scan_raster/beam_angles.hpp>
#include <glidar/render/scan_raster/grid_view.hpp>
#include <glidar/render/scan_raster/sector_table.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar::scan_raster {

/// Range of the tangents of all rows' elevations.
struct TangentRange {
  double low;
  double high;
};

/// The columns of a scanner's grid.
struct GridColumns {
  std::int32_t first = 0;   ///< the lowest column + shift of any beam
  std::uint32_t count = 0;  ///< from there to the highest
  double phase_rad = 0.0;   ///< azimuth of column 0
  double step_rad = 0.0;
};

/// Beams of a scanner as a grid of rows of equal elevation and columns of equal azimuth. Sectors
/// are groups of columns.
class ScannerGrid {
 public:
  void measure(const Beams& beams, ThreadPool& thread_pool);

  /// Why the beams form no grid; empty: they do. If not empty, nothing else is valid.
  [[nodiscard]] const std::string& misfit() const { return angles_.misfit; }

  [[nodiscard]] const GridColumns& columns() const { return columns_; }
  [[nodiscard]] TangentRange tangents() const {
    return {rows_.front().low_tangent, rows_.back().high_tangent};
  }
  /// The same for all sectors.
  [[nodiscard]] GridView view() const;
  [[nodiscard]] const std::vector<SectorTable>& sectors() const { return sectors_; }

  /// Rows of beams that are not in the grid.
  [[nodiscard]] const std::vector<std::uint32_t>& other_rows() const { return other_rows_; }

 private:
  void sort_rows();
  void find_misfit(const Beams& beams);
  void find_columns(const Beams& beams);
  void find_bins();
  void build_sectors(const Beams& beams, ThreadPool& thread_pool);

  BeamAngles angles_;
  std::vector<RowAngles> rows_;  ///< of the grid, rising
  std::vector<std::uint32_t> other_rows_;
  GridColumns columns_;
  SectorShape shape_;
  std::vector<float> low_deviation_;  ///< per row
  std::vector<float> high_deviation_;
  std::vector<std::int32_t> first_row_;  ///< per bin
  std::vector<std::int32_t> last_row_;
  double lowest_tangent_ = 0.0;
  double highest_tangent_ = 0.0;
  std::vector<SectorTable> sectors_;
};

}  // namespace glidar::scan_raster
