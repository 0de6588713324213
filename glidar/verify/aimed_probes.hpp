// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/verify/judge.hpp>

#include <cstdint>

namespace glidar {

/// A shape that beams are aimed at, relative to the sensor in axes of any kind.
struct AimedAt {
  const PlacedShape& placed;
  Eigen::Matrix3d sensor_from_axes;
  std::uint32_t number;  ///< of the random numbers
};

/// Beams at all vertices and at points on all edges of triangles around which every face is seen
/// from the front, and as many that may pass the shape.
Beams beams_at_vertices_and_edges(const AimedAt& at);

/// Beams that pass edges between a face seen from the front and one seen from behind by 1e-9 to
/// 1e-6 of the shape's radius, on either side.
Beams beams_beside_outline(const AimedAt& at);

}  // namespace glidar
