// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/sector_table.hpp>

#include <Eigen/Core>
#include <optional>
#include <span>

namespace glidar::scan_raster {

/// A beam and its place in a grid.
struct PlacedBeam {
  Eigen::Vector3d direction;
  double column;
  double row;
};

/// Columns and rows as the slopes side / forward and up / forward of directions: what a pinhole
/// camera with axes of its own has.
struct ProjectiveMap {
  SectorFrame frame;
  double columns_per_slope = 1.0;
  double middle_column = 0.0;  ///< of slope 0
  double rows_per_slope = 1.0;
  double middle_row = 0.0;
};

/// The map whose columns and rows are about those of the beams, by least squares; none where there
/// are too few beams, or they are all on a line.
std::optional<ProjectiveMap> fit_projective_map(std::span<const PlacedBeam> beams);

}  // namespace glidar::scan_raster
