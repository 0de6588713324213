// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/verify/comparison.hpp>

#include <cstdint>

namespace glidar {

/// A shape that beams are aimed at, relative to the sensor's position.
struct AimTarget {
  const PlacedShape& placed;
  Eigen::Matrix3d sensor_from_axes;
  std::uint32_t number;  ///< key of the random numbers
};

/// Beams at all vertices and edges whose faces are all front-facing, and beams through the scaled
/// vertices, most of which miss the shape.
Beams beams_at_vertices_and_edges(const AimTarget& at);

/// Beams that pass the silhouette edges (between a front face and a back face) at a distance of
/// 1e-9 to 1e-6 of the shape's radius, on either side.
Beams beams_beside_outline(const AimTarget& at);

}  // namespace glidar
