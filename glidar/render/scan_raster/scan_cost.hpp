// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/scan_raster/beam_grid.hpp>

namespace glidar::scan_raster {

/// Triangles and beams of a grid's view.
struct VisibleCounts {
  double triangles;  ///< in the grid's view
  double beams;      ///< that may hit a triangle
};

/// Estimates them from a sample of clusters. The result follows from the scene, the beams and the
/// poses alone; the resolver and the trees have those of the cast.
VisibleCounts estimate_visible(const BeamGrid& grid, const Beams& beams, const CpuBase& base);

}  // namespace glidar::scan_raster
