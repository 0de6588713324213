// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/cpu_base.hpp>
#include <glidar/render/scan_raster/beam_grid.hpp>

namespace glidar::scan_raster {

/// About how many triangles of a scene are in the view of a grid, for each of the beams that may
/// hit some. It follows from the scene, the beams and the poses; the resolver and the trees have
/// those of the cast. A sample of clusters is looked at.
double triangles_per_beam(const BeamGrid& grid, const Beams& beams, const CpuBase& base);

}  // namespace glidar::scan_raster
