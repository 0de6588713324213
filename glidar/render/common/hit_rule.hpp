// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

namespace glidar {

/// Limits of the hit rule. Within them no product overflows, and no relevant one underflows.
inline constexpr double kMaxHitOrigin = 0x1p240;     ///< of each coordinate of an origin: 1.8e72
inline constexpr double kMinHitDirection = 0x1p-64;  ///< of a direction's largest component
inline constexpr double kMaxHitDirection = 0x1p64;
/// Sheared coordinates below it count as zero: 5.7e-73, far below the smallest float, 1.4e-45.
inline constexpr double kMinHitCoordinate = 0x1p-240;

/// An origin counts as on a triangle, and does not hit it, within both of these bounds: 16
/// roundings of the products that determine its distance from the plane,
inline constexpr double kTouching = 0x1p-49;
/// and this fraction of the corners' size for that distance.
inline constexpr double kTouchingHeight = 0x1p-44;

/// A ray prepared for the hit rule, in the frame of a mesh's vertices. Make it with make_hit_ray().
struct HitRay {
  std::array<double, 3> origin;
  std::array<std::uint8_t, 3>
      axis;        ///< x, y, z of the sheared frame: z has the direction's largest component
  double shear_x;  ///< direction[axis[0]] / direction[axis[2]], at most 1
  double shear_y;
  double along;  ///< direction[axis[2]]
};

/// The corners of a triangle, as its mesh stores them.
struct HitTriangle {
  std::array<float, 3> a;
  std::array<float, 3> b;
  std::array<float, 3> c;
};

/// True when the rule is exact for this ray: coordinates of the origin up to kMaxHitOrigin, the
/// direction's largest component from kMinHitDirection to kMaxHitDirection, all numbers finite.
bool is_within_hit_limits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// Throws Error unless is_within_hit_limits(); `where` names the ray in the text: "beam 12".
void check_hit_limits(const std::string& where, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction);

/// A ray outside the limits hits nothing.
HitRay make_hit_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

/// The rule that decides what a ray hits. Returns the distance to the triangle, in lengths of the
/// direction; 0: no hit. One function for all renderers, in double, with the same bits on every
/// machine.
///
/// The corners are sheared so that the ray becomes the z axis (S. Woop, C. Benthin, I. Wald,
/// "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013). A sheared corner depends on the ray
/// and the vertex only, so triangles share it bit for bit. Three 2x2 determinants of exact sign
/// decide whether the axis is in the sheared triangle, borders included; a triangle seen edge-on is
/// not hit. Neighbours therefore leave no gap: the sheared mesh is continuous, and every point of
/// it is in a closed triangle.
///
/// The distance is within some roundings of the corners' distances. It is the same for every order
/// of the corners, and at a shared edge or vertex is the same for all triangles that share it.
double hit_distance(const HitRay& ray, const HitTriangle& triangle);

/// A triangle of a scene at its distance from a ray's origin.
struct HitCandidate {
  double distance;
  std::uint32_t instance;
  std::uint32_t primitive;
};

/// The order in which a ray hits triangles: by distance, then by instance, then by
/// triangle.
inline bool is_nearer(const HitCandidate& a, const HitCandidate& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  if (a.instance != b.instance) return a.instance < b.instance;
  return a.primitive < b.primitive;
}

}  // namespace glidar
