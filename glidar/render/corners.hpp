// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

namespace glidar {

/// Twice the areas of the three triangles between a point of a triangle's plane and its edges,
/// signed along the normal. Each is opposite to its corner; inside, all are positive.
struct CornerAreas {
  float at_0;
  float at_1;
  float at_2;
  float reach_squared;  ///< to the farthest corner; an area is wrong by some roundings of it
};

/// The areas around the hit point of a lane. Corners are first made relative to the point in
/// double, so that single precision suffices afterwards. Inlined, so that it is vectorised with its
/// loop.
[[gnu::always_inline]] inline CornerAreas areas_around(const ExactHits& e, const CornerBlock& c,
                                                       unsigned i) {
  const double x = e.origin.x[i] + e.distance[i] * e.direction.x[i];
  const double y = e.origin.y[i] + e.distance[i] * e.direction.y[i];
  const double z = e.origin.z[i] + e.distance[i] * e.direction.z[i];
  const auto ax = static_cast<float>(c.c0.x[i] - x);
  const auto ay = static_cast<float>(c.c0.y[i] - y);
  const auto az = static_cast<float>(c.c0.z[i] - z);
  const auto bx = static_cast<float>(c.c1.x[i] - x);
  const auto by = static_cast<float>(c.c1.y[i] - y);
  const auto bz = static_cast<float>(c.c1.z[i] - z);
  const auto cx = static_cast<float>(c.c2.x[i] - x);
  const auto cy = static_cast<float>(c.c2.y[i] - y);
  const auto cz = static_cast<float>(c.c2.z[i] - z);
  const auto nx = static_cast<float>(e.normal.x[i]);
  const auto ny = static_cast<float>(e.normal.y[i]);
  const auto nz = static_cast<float>(e.normal.z[i]);
  const float a_squared = ax * ax + ay * ay + az * az;
  const float b_squared = bx * bx + by * by + bz * bz;
  const float c_squared = cx * cx + cy * cy + cz * cz;
  const float ab_squared = a_squared > b_squared ? a_squared : b_squared;
  return {nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx),
          nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax),
          nx * (ay * bz - az * by) + ny * (az * bx - ax * bz) + nz * (ax * by - ay * bx),
          ab_squared > c_squared ? ab_squared : c_squared};
}

}  // namespace glidar
