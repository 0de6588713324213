// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/hit_rule.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace glidar::rays {

/// How many rays are traced together.
inline constexpr unsigned kPacketSize = 16;
inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// Sixteen rays in the frame of a mesh and the nearest triangle that each has found. Plain arrays,
/// because code for several instruction sets shares it. In single precision a ray starts `shift`
/// along itself, near the mesh, and distances are counted from there.
struct alignas(64) RayPacket {
  float direction[3][kPacketSize];
  /// The moved origin lies between these, by so much that a box that the true ray meets is also met
  /// by the ray in single precision.
  float origin_low[3][kPacketSize];
  float origin_high[3][kPacketSize];
  /// From middle_origin to each moved origin, and direction x offset. Unset if all are equal.
  float offset[3][kPacketSize];
  float moment[3][kPacketSize];
  /// What is known of the distance by the rule, minus shift: it is between these. Infinite: no hit.
  float low[kPacketSize];
  float high[kPacketSize];
  float near_low[kPacketSize];  ///< distance zero by the rule, minus shift, is between these
  float near_high[kPacketSize];
  std::uint32_t slot[kPacketSize];         ///< of the nearest triangle; kNoTriangle: no hit
  double exact_direction[3][kPacketSize];  ///< unit vectors
  double exact_origin[3][kPacketSize];
  double shift[kPacketSize];
  double distance[kPacketSize];  ///< to the nearest triangle by the rule, where `known` has a bit

  std::uint32_t active;     ///< bit i: ray i is traced
  bool has_common_origin;   ///< all origins are equal and no ray is moved
  double middle_origin[3];  ///< of the moved origins
  double spread;            ///< no moved origin is farther from it, in any coordinate
  float middle[3];          ///< of the active directions: each is within `half` of it
  float half[3];
  /// 2 |shift| + |o|_1 of the worst ray: origins relative to a cluster are computed in double, with
  /// errors of 2^-53 of it; the kernels allow 2^-26 of it before multiplying with 2^-24.
  double rounding;
  std::uint32_t known;     ///< bit i: distance[i] is computed
  std::uint32_t prepared;  ///< bit i: rule[i] is set
  HitRay rule[kPacketSize];
  std::uint32_t exact_tests;  ///< how often the rule was applied

  /// Set before start(). Distances of two triangles tie where they differ by at most
  /// kTiePart * tie_reach / |cos| (cos: of either normal and the ray); 0: only equal distances tie.
  double tie_reach = 0.0;
  /// Bit i: ray i met two triangles whose distances tie without being equal.
  std::uint32_t tied;
  /// Set before start(): false where a triangle lets a ray through. nullptr: none does.
  bool (*accepts_hit)(const void* context, unsigned lane, std::uint32_t primitive) = nullptr;
  const void* context = nullptr;  ///< the first argument of accepts_hit()
};

/// 512 roundings of a coordinate: those of two surfaces.
inline constexpr double kTiePart = 0x1p-43;

/// Where a mesh's vertices are: within `radius` of the centre.
struct MeshSphere {
  double centre[3] = {0.0, 0.0, 0.0};
  double radius = 0.0;
};

/// Rays that start farther from the centre than this many radii are moved towards the mesh.
inline constexpr double kUnmovedRadii = 4.0;

/// Sets exact_origin and exact_direction of one ray; the direction is a unit vector. When all are
/// set, Kernel::start() completes the packet.
inline void set_ray(RayPacket& packet, unsigned lane, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    packet.exact_origin[axis][lane] = origin[axis];
    packet.exact_direction[axis][lane] = direction[axis];
  }
}

}  // namespace glidar::rays
