// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// The hit of a sub-ray of a beam, in the sensor frame.
struct SubRayHit {
  Eigen::Vector3d position_m;
  Eigen::Vector3d normal;      ///< of the triangle, a unit vector towards the sensor
  double cos_incidence = 1.0;  ///< of the sub-ray, 0..1
  double range_m = 0.0;
  std::uint32_t ray = 0;  ///< index of the sub-ray in its beam
};

/// True if no continuous surface explains both points: the nearer one is in front of the tangent
/// plane of the other, and the farther one behind it, by more than the tolerance along the ray. At
/// an edge or on a curved surface that is visible from one point to the other, both are on the same
/// side: behind each other's plane where it is convex, in front where it is concave.
///
/// The tolerance is a quarter of the distance between the points, for surfaces that bend one way
/// and back between two sub-rays: such a bend occludes a part of itself only beyond two thirds of
/// the distance (a cubic from one plane to the other). It is at least 1e-6 of the range, for
/// single-precision coordinates of adjacent meshes.
bool has_gap(const SubRayHit& a, const SubRayHit& b);

/// True if the rays [first, first + count) all hit the same triangle, or all miss.
bool is_one_triangle(const Hits& hits, std::size_t first, std::size_t count);

/// Finds which sub-rays of a beam hit the same surface. Points without a gap whose normals differ
/// by at most 45 degrees are on one smooth face. Faces join at an edge if there is no gap between
/// any two of their points. Faces that join, directly or through others, are one surface.
class BeamSurfaces {
 public:
  /// Groups the sub-rays [first, first + count); requires the normals of the hits.
  void find(const Beams& rays, const Hits& hits, std::size_t first, std::size_t count);

  /// Groups these points.
  void find(std::vector<SubRayHit> points, std::size_t count);

  /// The surface number of a sub-ray: equal for sub-rays on one surface; 0 for a miss.
  [[nodiscard]] std::uint16_t of_ray(std::size_t ray) const { return of_ray_[ray]; }

 private:
  void label();
  [[nodiscard]] bool is_one_face() const;
  void find_faces();
  void join_faces();

  std::vector<SubRayHit> points_;
  std::vector<std::uint16_t> face_;     ///< per point: representative point of its face
  std::vector<std::uint16_t> surface_;  ///< per point: representative point of its surface
  std::vector<std::uint8_t> apart_;     ///< square matrix: 1 where two faces have a gap
  std::vector<std::uint16_t> of_ray_;
};

}  // namespace glidar
