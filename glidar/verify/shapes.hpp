// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Closed forms are worked out in extended precision (64 bits of mantissa on x86-64): next to
/// double it is exact.
using Real = long double;
using RealVector = Eigen::Matrix<Real, 3, 1>;

/// A shape whose surface is known without looking at triangles: flat faces, each a polygon of
/// vertices that are exact in single precision.
struct Shape {
  std::string name;
  Mesh mesh;  ///< inside the unit sphere
  std::vector<std::vector<std::uint32_t>>
      faces;          ///< convex polygons, counter-clockwise from outside
  bool solid = true;  ///< convex body; false: one face that is seen from both sides
};

/// Box, plane, tetrahedron, cylinder of 24 facets, sphere of 80 facets.
std::vector<Shape> make_shapes();

/// Adds an instance of a mesh of its own.
void add_shape(Scene& scene, Mesh mesh, double scale, const Pose& world_from_object);

/// All points with normal . p <= offset, relative to the sensor, in world axes.
struct HalfSpace {
  RealVector normal;  ///< unit, outwards
  Real offset = 0.0L;
};

/// A placed shape: the intersection of half spaces; a plane has its face's first and the sides
/// through its edges after it.
struct ClosedForm {
  std::vector<HalfSpace> sides;
  bool solid = true;
};

/// Where an object is seen from a viewpoint: p = rotation * (scale * p_object) + shift.
struct RealPlace {
  Eigen::Matrix<Real, 3, 3> rotation;
  RealVector shift;
};

/// In world axes, relative to a position in the world.
RealPlace place_from(const Pose& world_from_object, const Eigen::Vector3d& viewpoint);

/// A vertex of a mesh that is there.
RealVector place_vertex(const Mesh& mesh, std::uint32_t vertex, double scale,
                        const RealPlace& place);

ClosedForm make_closed_form(const Shape& shape, double scale, const RealPlace& place);

/// The shape at world_from_object * (scale * p), seen from a position in the world.
ClosedForm make_closed_form(const Shape& shape, double scale, const Pose& world_from_object,
                            const Eigen::Vector3d& viewpoint);

/// What a ray truly meets.
struct TrueHit {
  bool hit = false;
  /// False when the ray passes an edge or silhouette nearer than the tolerance, or grazes the
  /// surface: single precision may then rightly decide either way.
  bool clear = true;
  Real range_m = 0.0L;
  RealVector normal;  ///< unit, turned towards the ray's origin, world axes
};

/// Below this cosine between ray and normal a ray grazes the surface.
inline constexpr Real kGrazingCosine = 1e-3L;

/// Origin relative to the viewpoint, direction of unit length, both in world axes; the origin is
/// outside the shape. Convex bodies by clipping the ray with every half space (Cyrus and Beck
/// 1978).
TrueHit intersect(const ClosedForm& form, const RealVector& origin, const RealVector& direction,
                  Real edge_tolerance_m);

/// Where a ray from inside a convex body, or from a point of its surface, leaves it; a miss where
/// it does not go through it. A ray from the surface that runs along it is not clear.
TrueHit leave(const ClosedForm& form, const RealVector& origin, const RealVector& direction,
              Real edge_tolerance_m);

}  // namespace glidar
