// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/triangle_blocks.hpp>
#include <glidar/render/rays/ray_packet.hpp>

#include <array>
#include <cstdint>

namespace glidar::rays {

/// Applies the hit rule to a triangle that single precision cannot decide, and to the ray's nearest
/// one if its distance is still unknown; keeps the nearer.
void retest_exactly(const TriangleBlock* blocks, RayPacket& packet, unsigned lane,
                    std::uint32_t slot);

/// True for two triangles with the same corners in any order: by the rule, their distances are
/// equal.
bool have_same_corners(const TriangleBlock* blocks, std::uint32_t slot, std::uint32_t other);

/// Distance by which a triangle may be farther and still tie with this one, see
/// RayPacket::tie_reach; the ray's direction is a unit vector.
double tie_window(double reach, const HitTriangle& triangle,
                  const std::array<double, 3>& direction);

/// True where a ray must be searched for ties because it hits both of two triangles: their
/// distances differ by at most the larger of their windows, or are equal and the triangle found
/// later replaces the other. `apart`: the difference of the distances.
bool may_tie(double apart, double window, bool replaces);

/// Computes packet.distance of every active ray that hits, by the rule.
void complete_distances(const TriangleBlock* blocks, RayPacket& packet);

/// Index in the mesh of the triangle that a ray hits; kNoTriangle: none.
inline std::uint32_t primitive_of(const TriangleBlock* blocks, const RayPacket& packet,
                                  unsigned lane) {
  const std::uint32_t slot = packet.slot[lane];
  if (slot == kNoTriangle) return kNoTriangle;
  return blocks[slot / kBlockSize].primitive[slot % kBlockSize];
}

}  // namespace glidar::rays
