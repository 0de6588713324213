// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolve.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace glidar {

/// Who was hit; instance kNoHit: nobody.
struct Found {
  std::uint32_t instance = kNoHit;
  std::uint32_t primitive = kNoHit;

  bool operator==(const Found&) const = default;
};

/// How far inside a triangle a point of its plane lies, object units: the smallest signed distance
/// to an edge.
double distance_inside(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& normal,
                       const Eigen::Vector3d& point);

/// Rounding in double of a point at most `length` from the zero of its frame: a beam this far
/// outside a border is on it.
inline double slack(double length) {
  constexpr double kSlackPerLength = 0x1p-44;  // 256 roundings of a coordinate
  return kSlackPerLength * length;
}

/// Weighs triangles for one beam, exactly: for renderers that found one in single precision.
struct Judgement {
  const Resolver& resolver;
  const Beams& beams;
  std::size_t beam;
  double slack_m;
  Found nearest = {};  ///< of those the beam meets
  Found closest = {};  ///< to the beam, of those it misses by more than rounding
  double nearest_range_m = std::numeric_limits<double>::infinity();
  double closest_inside_m = -std::numeric_limits<double>::infinity();

  void consider(const Found& candidate);
};

}  // namespace glidar
