// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/sector_table.hpp>

#include <Eigen/Core>
#include <optional>
#include <span>

namespace glidar::scan_raster {

/// A beam and its position in a grid.
struct PlacedBeam {
  Eigen::Vector3d direction;
  double column;
  double row;
};

/// Columns and rows as linear functions of the slopes side / forward and up / forward of
/// directions, as for a pinhole camera with its own axes.
struct ProjectiveMap {
  SectorFrame frame;
  double columns_per_slope = 1.0;
  double middle_column = 0.0;  ///< of slope 0
  double rows_per_slope = 1.0;
  double middle_row = 0.0;
};

/// Least-squares fit of columns and rows; none if there are too few beams, or all are on a line.
std::optional<ProjectiveMap> fit_projective_map(std::span<const PlacedBeam> beams);

}  // namespace glidar::scan_raster
