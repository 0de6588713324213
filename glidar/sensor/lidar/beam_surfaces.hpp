// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// What a sub-ray of a beam hit, in the sensor's frame.
struct SurfacePoint {
  Eigen::Vector3d position_m;
  Eigen::Vector3d normal;      ///< of the triangle, a unit vector towards the sensor
  double cos_incidence = 1.0;  ///< of the sub-ray, 0..1
  double range_m = 0.0;
  std::uint32_t ray = 0;  ///< which of the beam's sub-rays
};

/// True when no continuous surface explains both points: each is on the other side of the other's
/// tangent plane (the nearer one in front, the farther one behind), by more than the tolerance
/// along the ray. At an edge or on a curved surface that is visible from one point to the other,
/// both lie on the same side: behind each other's plane where it is convex, in front where it is
/// concave.
///
/// The tolerance is a quarter of the distance between the points, for surfaces that bend one way
/// and back between two sub-rays: such a bend hides a part of itself only beyond two thirds of it
/// (a cubic from one plane to the other). And 1e-6 of the range, for coordinates in single
/// precision of meshes that join.
bool has_gap(const SurfacePoint& a, const SurfacePoint& b);

/// Finds which sub-rays of a beam hit the same surface. Points without a gap whose normals are
/// within 45 degrees are of one smooth face; faces between no two of whose points there is a gap
/// join at an edge; faces that join, directly or by others, are one surface.
class BeamSurfaces {
 public:
  /// The surfaces of `count` sub-rays from `first` on; needs the normals of the hits.
  void find(const Beams& rays, const Hits& hits, std::size_t first, std::size_t count);

  /// The same for points that are known.
  void find(std::vector<SurfacePoint> points, std::size_t count);

  /// Which surface a sub-ray hit: equal numbers, same surface. 0 where it hit nothing.
  [[nodiscard]] std::uint16_t of_ray(std::size_t ray) const { return of_ray_[ray]; }

 private:
  void label();
  [[nodiscard]] bool is_one_face() const;
  void find_faces();
  void join_faces();

  std::vector<SurfacePoint> points_;
  std::vector<std::uint16_t> face_;     ///< per point: one of its face
  std::vector<std::uint16_t> surface_;  ///< per point: one of its surface
  std::vector<std::uint8_t> apart_;     ///< faces with a gap between them, as a square
  std::vector<std::uint16_t> of_ray_;
};

}  // namespace glidar
