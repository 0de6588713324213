// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/lanes.hpp>

#include <vector>

namespace glidar {

/// Where the columns and rows of a pinhole cross the plane at depth 1; empty for other beams. To
/// work directions out from these is quicker than to read them.
struct PlanePoints {
  std::vector<double> x;  ///< per column
  std::vector<double> y;  ///< per row
};

void find_plane_points(const Beams& beams, PlanePoints& points);

/// direction_through(), lane by lane.
void directions_through(const Lanes<double>& x, const Lanes<double>& y, Lanes3<double>& out);

}  // namespace glidar
