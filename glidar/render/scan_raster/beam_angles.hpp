// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/math/thread_pool.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar::scan_raster {

/// A row of beams as a row of the grid: column c has approximately the azimuth
/// phase + (c + shift) * step of the grid; deviations are measured.
struct RowAngles {
  std::uint32_t source = 0;  ///< row of the beams
  bool is_in_grid = false;   ///< otherwise its beams are cast as rays
  double low_tangent = 0.0;  ///< minimum tangent of the elevations
  double high_tangent = 0.0;
  std::int32_t shift = 0;      ///< columns
  double low_deviation = 0.0;  ///< of azimuths from those of their columns, in columns
  double high_deviation = 0.0;
};

/// Measurements of a row before the grid is known.
struct RawRow {
  std::size_t beams = 0;
  bool is_steep = false;
  double low_tangent = 0.0;
  double high_tangent = 0.0;
  double step_rad = 0.0;   ///< mean step between columns
  double phase_rad = 0.0;  ///< middle of azimuth - column * step
  double spread_rad = 0.0;
};

/// Azimuths and elevations of beams, and how well they fit a grid.
struct BeamAngles {
  double phase_rad = 0.0;  ///< azimuth of column 0
  double step_rad = 0.0;   ///< from column to column, signed
  std::vector<RowAngles> rows;
  std::string misfit;  ///< why the beams form no grid; empty: they do

  std::vector<double> azimuths_rad;  ///< per beam; NaN where there is none
  std::vector<RawRow> raw;           ///< per row of the beams
};

/// A quick test on some neighbours. False if the beams are certainly not those of a scanner, or
/// most are missing.
bool may_form_scan(const Beams& beams);

/// Measures beams. Azimuths and elevations are those about axes_of(beams).
void measure_angles(const Beams& beams, ThreadPool& thread_pool, BeamAngles& angles);

}  // namespace glidar::scan_raster
