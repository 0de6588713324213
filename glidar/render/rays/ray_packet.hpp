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
/// because code for several instruction sets shares it. In single precision, a ray starts `shift`
/// along its direction, near the mesh, and distances are relative to that point.
struct alignas(64) RayPacket {
  float direction[3][kPacketSize];
  /// Interval of the shifted origin, wide enough that a ray in single precision enters every box
  /// that the true ray enters.
  float origin_low[3][kPacketSize];
  float origin_high[3][kPacketSize];
  /// From middle_origin to each shifted origin, and direction x offset. Unset if all are equal.
  float offset[3][kPacketSize];
  float moment[3][kPacketSize];
  /// Bounds of the rule's distance minus shift. Infinite: no hit.
  float low[kPacketSize];
  float high[kPacketSize];
  float near_low[kPacketSize];  ///< bounds of distance zero minus shift
  float near_high[kPacketSize];
  std::uint32_t slot[kPacketSize];         ///< of the nearest triangle; kNoTriangle: no hit
  double exact_direction[3][kPacketSize];  ///< unit vectors
  double exact_origin[3][kPacketSize];
  double shift[kPacketSize];
  double distance[kPacketSize];  ///< to the nearest triangle by the rule, where `known` is set

  std::uint32_t active;     ///< bit i: ray i is traced
  bool has_common_origin;   ///< all origins are equal and no ray is shifted
  double middle_origin[3];  ///< of the shifted origins
  double spread;            ///< maximum distance of shifted origins from it, per coordinate
  float middle[3];          ///< of the active directions, which are within `half` of it
  float half[3];
  /// 2 |shift| + |o|_1 maximum over all rays: origins relative to a cluster are computed in double,
  /// with errors of 2^-53 of it; the kernels allow 2^-26 of it before multiplying with 2^-24.
  double rounding;
  std::uint32_t known;     ///< bit i: distance[i] is computed
  std::uint32_t prepared;  ///< bit i: rule[i] is set
  HitRay rule[kPacketSize];
  std::uint32_t exact_tests;  ///< number of applications of the rule

  /// Set before start(). Distances of two triangles tie where they differ by at most
  /// kTiePart * tie_reach / |cos| (cos: of either normal and the ray); 0: only equal distances tie.
  double tie_reach = 0.0;
  /// Bit i: ray i met two triangles whose distances tie but differ.
  std::uint32_t tied;
  /// Set before start(): false where a triangle lets a ray pass. nullptr: all triangles block rays.
  bool (*accepts_hit)(const void* context, unsigned lane, std::uint32_t primitive) = nullptr;
  const void* context = nullptr;  ///< the first argument of accepts_hit()
};

/// 512 roundings of a coordinate: those of two surfaces.
inline constexpr double kTiePart = 0x1p-43;

/// Bounding sphere of a mesh's vertices.
struct MeshSphere {
  double centre[3] = {0.0, 0.0, 0.0};
  double radius = 0.0;
};

/// Rays that start farther from the centre than this many radii are shifted towards the mesh.
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
