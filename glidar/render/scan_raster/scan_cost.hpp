// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/scan_raster/beam_grid.hpp>

namespace glidar::scan_raster {

/// What a grid sees.
struct VisibleCounts {
  double triangles;  ///< in the grid's view
  double beams;      ///< that may hit some
};

/// About that. It follows from the scene, the beams and the poses; the resolver and the trees have
/// those of the cast. A sample of clusters is looked at.
VisibleCounts estimate_visible(const BeamGrid& grid, const Beams& beams, const CpuBase& base);

}  // namespace glidar::scan_raster
