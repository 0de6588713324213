// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/exact_test.hpp>
#include <glidar/render/rays/packet_start.hpp>
#include <glidar/render/rays/ray_tree.hpp>
#include <glidar/render/rays/triangle_filter.hpp>

// Tests rays of a packet with the triangles of a cluster.
namespace glidar::rays::GLIDAR_KERNEL {

/// Bits of the triangles in a block of a cluster, without repeated ones.
GLIDAR_INLINE std::uint32_t present(const TriangleCluster& cluster, std::uint32_t block) {
  const std::uint32_t left = cluster.count - block * kBlockSize;
  return left < kBlockSize ? (1U << left) - 1U : 0xFFU;
}

/// Calls act(i) for every bit.
template <class Act>
GLIDAR_INLINE void for_bits(std::uint32_t set, const Act& act) {
  for (; set != 0; set &= set - 1) act(static_cast<unsigned>(__builtin_ctz(set)));
}

/// An origin relative to a cluster's centre.
struct LocalOrigin {
  float at[3];
  double reach;  ///< to the farthest corner, in the largest coordinate
};

GLIDAR_INLINE LocalOrigin local_origin(const double (&of_rays)[3], const TriangleCluster& cluster,
                                       double rounding) {
  LocalOrigin origin;
  double largest = 0.0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double x = of_rays[axis] - static_cast<double>(cluster.centre[axis]);
    origin.at[axis] = static_cast<float>(x);
    largest = larger(largest, __builtin_fabs(x));
  }
  origin.reach = largest + static_cast<double>(cluster.radius) + rounding * 0x1p-26;
  return origin;
}

/// The shifted origin of one ray.
GLIDAR_INLINE LocalOrigin local_origin(const RayPacket& p, unsigned lane,
                                       const TriangleCluster& cluster) {
  double moved[3];
  for (unsigned axis = 0; axis < 3; ++axis) {
    moved[axis] = p.exact_origin[axis][lane] + p.shift[lane] * p.exact_direction[axis][lane];
  }
  return local_origin(moved, cluster, p.rounding);
}

/// Applies the rule to one triangle and some rays.
inline void retest_lanes(const TreeView& tree, RayPacket& p, std::uint32_t lanes,
                         std::uint32_t slot) {
  for_bits(lanes, [&](unsigned lane) { retest_exactly(tree.blocks, p, lane, slot); });
}

/// Applies the rule to all triangles, where single precision has no error bounds.
inline void retest_all(const TreeView& tree, const TriangleCluster& cluster, RayPacket& p,
                       std::uint32_t lanes) {
  const std::uint32_t first = cluster.first_block * kBlockSize;
  for (std::uint32_t i = 0; i < cluster.count; ++i) retest_lanes(tree, p, lanes, first + i);
}

/// Sets the triangle as a ray's nearest.
GLIDAR_INLINE void accept(RayPacket& p, unsigned lane, std::uint32_t slot, float low, float high) {
  p.low[lane] = low;
  p.high[lane] = high;
  p.slot[lane] = slot;
  p.known &= ~(1U << lane);
}

/// The edge functions of one ray and eight triangles.
GLIDAR_INLINE EdgeTest<Float8> edges_of(const RayPacket& p, unsigned lane, const BlockSetup& s) {
  const Vector<Float8> d = {Float8::all(p.direction[0][lane]), Float8::all(p.direction[1][lane]),
                            Float8::all(p.direction[2][lane])};
  return {dot(d, s.q2), dot(d, s.q1), dot(d, s.n)};
}

/// Tests one ray with the triangles of a cluster, eight at a time.
inline void test_ray(const TreeView& tree, const TriangleCluster& cluster, RayPacket& p,
                     unsigned lane) {
  const LocalOrigin origin = local_origin(p, lane, cluster);
  if (!(origin.reach < kMaxReach)) return retest_all(tree, cluster, p, 1U << lane);
  const float scaled = scaled_reach(origin.reach);
  for (std::uint32_t b = 0; b < block_count(cluster.count); ++b) {
    const std::uint32_t block = cluster.first_block + b;
    const BlockSetup s = set_up(tree.blocks[block], cluster, origin.at, scaled);
    const EdgeTest<Float8> edges = edges_of(p, lane, s);
    const Mask8 outside = (edges.lowest < -s.bounds.edge) & (edges.highest > s.bounds.edge);
    const std::uint32_t candidates = ~bits(outside) & present(cluster, b);
    if (candidates == 0) continue;
    const Interval<Float8> best = {Float8::all(p.low[lane]), Float8::all(p.high[lane]),
                                   Float8::all(p.near_low[lane]), Float8::all(p.near_high[lane])};
    const FilterResult<Float8> result =
        classify(edges, Float8::mask(candidates), s.det, s.bounds, best);
    const std::uint32_t accepted = p.accepts_hit == nullptr ? bits(result.accepted) : 0;
    alignas(32) float low[kBlockSize];
    alignas(32) float high[kBlockSize];
    store(low, result.low);
    store(high, result.high);
    for_bits(bits(result.accepted) | bits(result.uncertain), [&](unsigned i) {
      const std::uint32_t slot = block * kBlockSize + i;
      const bool is_sure = (accepted >> i & 1U) != 0;
      if (is_sure && high[i] < p.low[lane]) return accept(p, lane, slot, low[i], high[i]);
      if (is_sure && low[i] > p.high[lane]) return;  // an earlier triangle is nearer
      retest_exactly(tree.blocks, p, lane, slot);
    });
  }
}

}  // namespace glidar::rays::GLIDAR_KERNEL
