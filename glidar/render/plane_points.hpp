// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/lanes.hpp>

#include <vector>

namespace glidar {

/// Normalised image coordinates of a pinhole's columns and rows (on the plane at depth 1); empty
/// for other beams. Computing directions from them is faster than reading the directions.
struct PlanePoints {
  std::vector<double> x;  ///< per column
  std::vector<double> y;  ///< per row
};

void find_plane_points(const Beams& beams, PlanePoints& points);

/// direction_through(), lane by lane.
void directions_through(const Lanes<double>& x, const Lanes<double>& y, Lanes3<double>& out);

}  // namespace glidar
