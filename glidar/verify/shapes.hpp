// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// Closed forms are evaluated in extended precision (64-bit mantissa on x86-64), which is exact
/// compared with double.
using Real = long double;
using RealVector = Eigen::Matrix<Real, 3, 1>;
using RealMatrix = Eigen::Matrix<Real, 3, 3>;

/// A shape with a surface in closed form: flat faces, each a polygon of vertices that are exact in
/// single precision.
struct Shape {
  std::string name;
  Mesh mesh;  ///< inside the unit sphere
  std::vector<std::vector<std::uint32_t>>
      faces;          ///< convex polygons, counter-clockwise from outside
  bool solid = true;  ///< convex body; false: one two-sided face
};

/// Box, plane, tetrahedron, cylinder of 24 facets, sphere of 80 facets.
std::vector<Shape> make_shapes();

/// Adds a mesh and an instance of it.
void add_shape(Scene& scene, Mesh mesh, double scale, const Pose& world_from_object);

/// All points with normal . p <= offset, relative to the sensor, in world axes.
struct HalfSpace {
  RealVector normal;  ///< unit, outwards
  Real offset = 0.0L;
};

/// A placed shape as an intersection of half spaces. A plane has the half space of its face first,
/// then those through its edges.
struct ClosedForm {
  std::vector<HalfSpace> sides;
  bool solid = true;
};

/// The pose of an object relative to a viewpoint: p = rotation * (scale * p_object) + shift.
struct ExactPose {
  RealMatrix rotation;
  RealVector shift;
};

/// The pose relative to a position in the world, in world axes.
ExactPose relative_pose(const Pose& world_from_object, const Eigen::Vector3d& viewpoint);

/// A vertex of a mesh with this scale and pose.
RealVector exact_vertex(const Mesh& mesh, std::uint32_t vertex, double scale,
                        const ExactPose& pose);

ClosedForm make_closed_form(const Shape& shape, double scale, const ExactPose& pose);

/// The shape at world_from_object * (scale * p), relative to a position in the world.
ClosedForm make_closed_form(const Shape& shape, double scale, const Pose& world_from_object,
                            const Eigen::Vector3d& viewpoint);

/// The exact hit of a ray.
struct ExactHit {
  bool hit = false;
  /// False if the ray passes an edge or silhouette nearer than the tolerance, or at grazing
  /// incidence: either decision is then correct in single precision.
  bool clear = true;
  Real range_m = 0.0L;
  RealVector normal;  ///< unit, oriented towards the ray's origin, world axes
};

/// Cosine between ray and normal below which the incidence is grazing.
inline constexpr Real kGrazingCosine = 1e-3L;

/// Intersects a ray whose origin is outside the shape. The origin is relative to the viewpoint, the
/// direction has unit length, both in world axes. Convex bodies by clipping the ray with every half
/// space (Cyrus and Beck 1978).
ExactHit intersect(const ClosedForm& form, const RealVector& origin, const RealVector& direction,
                   Real edge_tolerance_m);

/// The point at which a ray from inside a convex body, or from its surface, leaves the body; a miss
/// if the ray does not pass through it. A ray along the surface is not clear.
ExactHit intersect_from_inside(const ClosedForm& form, const RealVector& origin,
                               const RealVector& direction, Real edge_tolerance_m);

}  // namespace glidar
