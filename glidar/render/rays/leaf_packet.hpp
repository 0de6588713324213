// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/block_rows.hpp>
#include <glidar/render/rays/leaf_test.hpp>

// Tests many rays of a packet with the triangles of a cluster: first eight triangles at once with
// the bounds of all directions, then the remaining triangles with single rays.
namespace glidar::rays::GLIDAR_KERNEL {

/// The directions of a packet, as one box.
struct DirectionBox {
  Vector<Float8> middle;
  Vector<Float8> half;

  GLIDAR_INLINE explicit DirectionBox(const RayPacket& p)
      : middle{Float8::all(p.middle[0]), Float8::all(p.middle[1]), Float8::all(p.middle[2])},
        half{Float8::all(p.half[0]), Float8::all(p.half[1]), Float8::all(p.half[2])} {}

  /// The maximum of d.q for any direction d in the box.
  [[nodiscard]] GLIDAR_INLINE Float8 max_dot(const Vector<Float8>& q) const {
    return dot(middle, q) + dot(half, magnitude(q));
  }
};

/// Upper bound of the smallest edge function for a packet; signs are flipped so that edge functions
/// of a hit are positive.
GLIDAR_INLINE Float8 edge_function_bound(const DirectionBox& box, const Vector<Float8>& q1,
                                         const Vector<Float8>& q2, const Vector<Float8>& n) {
  return min(min(box.max_dot(q1), box.max_dot(q2)), box.max_dot(n - q1 - q2));
}

/// Rays [first, first + LaneFloat::kWidth) of three rows.
GLIDAR_INLINE Vector<LaneFloat> lanes_of(const float (&rows)[3][kPacketSize], unsigned first) {
  return {LaneFloat::load(rows[0] + first), LaneFloat::load(rows[1] + first),
          LaneFloat::load(rows[2] + first)};
}

/// A triangle's slot and the rays that it is tested with.
struct LaneGroup {
  unsigned first;         ///< rays [first, first + LaneFloat::kWidth)
  LaneFloat::Mask lanes;  ///< those that are not surely outside
  std::uint32_t slot;
};

/// Classifies one triangle for some rays, keeps it where it is surely nearer, and re-tests it
/// exactly where that is uncertain.
GLIDAR_INLINE void update_nearest(const TreeView& tree, RayPacket& p, const LaneGroup& group,
                                  const EdgeTest<LaneFloat>& edges, LaneFloat det,
                                  const ErrorBounds<LaneFloat>& bounds) {
  const unsigned first = group.first;
  const Interval<LaneFloat> best = {LaneFloat::load(p.low + first), LaneFloat::load(p.high + first),
                                    LaneFloat::load(p.near_low + first),
                                    LaneFloat::load(p.near_high + first)};
  const FilterResult<LaneFloat> result = classify(edges, group.lanes, det, bounds, best);
  const std::uint32_t inside = bits(result.accepted);
  const std::uint32_t accepted = p.accepts_hit == nullptr ? inside : 0;
  if (accepted != 0) {
    store(p.low + first, select(result.accepted, result.low, best.low));
    store(p.high + first, select(result.accepted, result.high, best.high));
    p.known &= ~(accepted << first);
    for_bits(accepted, [&](unsigned i) { p.slot[first + i] = group.slot; });
  }
  for_bits((inside & ~accepted) | bits(result.uncertain),
           [&](unsigned i) { retest_exactly(tree.blocks, p, first + i, group.slot); });
}

/// Tests rays with a common origin with one triangle. Rows: q1, q2, n, det, bounds, all turned so
/// that det is positive; then the edge functions of a hit are not negative.
GLIDAR_INLINE void test_common_triangle(const TreeView& tree, RayPacket& p, std::uint32_t lanes,
                                        const BlockRows<LaneFloat, 13>& rows, std::uint32_t slot) {
  const unsigned i = slot % kBlockSize;
  const Vector<LaneFloat> q1 = rows.all3(0, i);
  const Vector<LaneFloat> q2 = rows.all3(3, i);
  const Vector<LaneFloat> n = rows.all3(6, i);
  const ErrorBounds<LaneFloat> bounds = rows.bounds(10, i);
  for (unsigned first = 0; first < kPacketSize; first += LaneFloat::kWidth) {
    const Vector<LaneFloat> d = lanes_of(p.direction, first);
    const EdgeTest<LaneFloat> edges(dot(d, q2), dot(d, q1), dot(d, n));
    const auto left = ~(edges.lowest < -bounds.edge) & LaneFloat::mask(lanes >> first);
    if (bits(left) == 0) continue;
    update_nearest(tree, p, {first, left, slot}, edges, rows.all(9, i), bounds);
  }
}

/// Tests rays with a common origin with the triangles of a cluster.
inline void test_common(const TreeView& tree, const TriangleCluster& cluster, RayPacket& p,
                        std::uint32_t lanes, const LocalOrigin& origin) {
  const float scaled = scaled_reach(origin.reach);
  const DirectionBox box(p);
  for (std::uint32_t b = 0; b < block_count(cluster.count); ++b) {
    const std::uint32_t block = cluster.first_block + b;
    const BlockSetup s = set_up(tree.blocks[block], cluster, origin.at, scaled);
    const Vector<Float8> q1 = flip_sign(s.q1, s.det);
    const Vector<Float8> q2 = flip_sign(s.q2, s.det);
    const Vector<Float8> n = flip_sign(s.n, s.det);
    const Float8 det = magnitude(s.det);
    const Mask8 faces = det > s.bounds.det;  // its sign is certain
    const Mask8 outside = edge_function_bound(box, q1, q2, n) < s.bounds.edge * Float8::all(-2.0F);
    const std::uint32_t left = ~bits(outside & faces) & present(cluster, b);
    if (left == 0) continue;
    BlockRows<LaneFloat, 13> rows;
    rows.set(0, q1);
    rows.set(3, q2);
    rows.set(6, n);
    rows.set(9, det);
    rows.set(10, s.bounds);
    const std::uint32_t facing = bits(faces);
    for_bits(left & facing, [&](unsigned i) {
      test_common_triangle(tree, p, lanes, rows, block * kBlockSize + i);
    });
    for_bits(left & ~facing,
             [&](unsigned i) { retest_lanes(tree, p, lanes, block * kBlockSize + i); });
  }
}

/// Tests rays with separate origins with one triangle. Rows: q1, q2, n, det about the middle
/// of the origins; e1, e2, bounds. From an origin s beside the middle, the edge functions of a
/// direction d are d.q1 - e1.(d x s) and d.q2 + e2.(d x s), and det is less by s.n.
GLIDAR_INLINE void test_spread_triangle(const TreeView& tree, RayPacket& p, std::uint32_t lanes,
                                        const BlockRows<LaneFloat, 19>& rows, std::uint32_t slot) {
  const unsigned i = slot % kBlockSize;
  const Vector<LaneFloat> q1 = rows.all3(0, i);
  const Vector<LaneFloat> q2 = rows.all3(3, i);
  const Vector<LaneFloat> n = rows.all3(6, i);
  const Vector<LaneFloat> e1 = rows.all3(10, i);
  const Vector<LaneFloat> e2 = rows.all3(13, i);
  const ErrorBounds<LaneFloat> bounds = rows.bounds(16, i);
  for (unsigned first = 0; first < kPacketSize; first += LaneFloat::kWidth) {
    const Vector<LaneFloat> d = lanes_of(p.direction, first);
    const Vector<LaneFloat> moment = lanes_of(p.moment, first);
    const EdgeTest<LaneFloat> edges(dot(d, q2) + dot(moment, e2), dot(d, q1) - dot(moment, e1),
                                    dot(d, n));
    const auto outside = (edges.lowest < -bounds.edge) & (edges.highest > bounds.edge);
    const auto left = ~outside & LaneFloat::mask(lanes >> first);
    if (bits(left) == 0) continue;
    const LaneFloat det = rows.all(9, i) - dot(lanes_of(p.offset, first), n);
    update_nearest(tree, p, {first, left, slot}, edges, det, bounds);
  }
}

/// The rays of a packet with separate origins. The setup about the middle of the origins rejects
/// triangles for all rays: moved by the spread, an edge function changes by at most
/// 1.8 spread (s1 + s2), and det by spread s1 s2.
struct PacketBounds {
  DirectionBox box;
  Float8 edge_margin;
  Float8 det_margin;

  GLIDAR_INLINE PacketBounds(const RayPacket& p, float spread, float scaled)
      : box(p),
        edge_margin(
            Float8::all(-(2.0F + 1.81F * spread / scaled))),  // bounds.edge > scaled (s1 + s2)
        det_margin(Float8::all(spread * (1.01F / (10.0F * 0x1p-24F)))) {}

  [[nodiscard]] GLIDAR_INLINE Mask8 are_outside(const BlockSetup& s) const {
    const Float8 bound = edge_function_bound(box, flip_sign(s.q1, s.det), flip_sign(s.q2, s.det),
                                             flip_sign(s.n, s.det));
    const Mask8 faces = magnitude(s.det) > multiply_add(s.bounds.den, det_margin, s.bounds.det);
    return (bound < s.bounds.edge * edge_margin) & faces;
  }
};

/// Tests rays with separate origins with the triangles of a cluster.
inline void test_spread(const TreeView& tree, const TriangleCluster& cluster, RayPacket& p,
                        std::uint32_t lanes, const LocalOrigin& origin) {
  const float scaled = scaled_reach(origin.reach);
  const PacketBounds bounds(p, static_cast<float>(p.spread), scaled);
  for (std::uint32_t b = 0; b < block_count(cluster.count); ++b) {
    const std::uint32_t block = cluster.first_block + b;
    const BlockSetup s = set_up(tree.blocks[block], cluster, origin.at, scaled);
    const std::uint32_t left = ~bits(bounds.are_outside(s)) & present(cluster, b);
    if (left == 0) continue;
    BlockRows<LaneFloat, 19> rows;
    rows.set(0, s.q1);
    rows.set(3, s.q2);
    rows.set(6, s.n);
    rows.set(9, s.det);
    rows.set(10, s.corners.e1);
    rows.set(13, s.corners.e2);
    rows.set(16, s.bounds);
    for_bits(left, [&](unsigned i) {
      test_spread_triangle(tree, p, lanes, rows, block * kBlockSize + i);
    });
  }
}

/// Tests the rays of `lanes` with the triangles of a cluster.
inline void test_leaf(const TreeView& tree, std::uint32_t index, RayPacket& p,
                      std::uint32_t lanes) {
  constexpr int kFewLanes = 2;
  const TriangleCluster& cluster = tree.clusters[index];
  if (__builtin_popcount(lanes) <= kFewLanes) {
    for_bits(lanes, [&](unsigned lane) { test_ray(tree, cluster, p, lane); });
    return;
  }
  LocalOrigin origin = local_origin(p.middle_origin, cluster, p.rounding);
  origin.reach += p.spread;
  if (!(origin.reach < kMaxReach)) return retest_all(tree, cluster, p, lanes);
  if (p.has_common_origin) return test_common(tree, cluster, p, lanes, origin);
  test_spread(tree, cluster, p, lanes, origin);
}

}  // namespace glidar::rays::GLIDAR_KERNEL
