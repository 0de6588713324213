// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/cones.hpp>
#include <glidar/render/rays/tree_traversal.hpp>

// Finds the triangles that the rays of cones may hit. docs/internals/ray-casting.md derives
// the bounds.
namespace glidar::rays::GLIDAR_KERNEL {

/// Covers the rounding of bounds that are computed with up to 32 roundings.
inline constexpr float kUp = 1.0F + 0x1p-19F;
inline constexpr float kDown = 1.0F - 0x1p-19F;

/// |a|; the term against underflow adds at most 2^-63.
GLIDAR_INLINE Float8 length(const Vector<Float8>& a) {
  const Float8 tiny = Float8::all(0x1p-126F);
  return square_root(multiply_add(a.x, a.x, multiply_add(a.y, a.y, multiply_add(a.z, a.z, tiny))));
}

/// How far rays of the cones may be from the ray of their lane, in a box of the tree.
struct ConeWidth {
  float slope;
  float middle[3];
  float reach[3];  ///< of all origins about the middle

  template <class F>
  [[nodiscard]] GLIDAR_INLINE F of(const F (&low)[3], const F (&high)[3]) const {
    F squared = F::all(0.0F);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const F o = F::all(middle[axis]);
      const F far = max(magnitude(low[axis] - o), magnitude(high[axis] - o)) + F::all(reach[axis]);
      squared = multiply_add(far, far, squared);
    }
    return square_root(squared) * F::all(slope);
  }
};

/// Widens the bounds of a started packet from its rays to the cones around them.
GLIDAR_INLINE ConeWidth widen(RayPacket& p, Cones& c) {
  double shift = 0.0;
  for (const double x : p.shift) shift = larger(shift, x);
  // Origins in an instance's frame are rounded by 2^-53 of p.rounding.
  c.radius = kUp * (c.radius + c.slope * static_cast<float>(shift)) +
             0x1p-48F * static_cast<float>(p.rounding);
  ConeWidth width;
  width.slope = c.slope * (1.0F + 0x1p-10F);
  if (p.has_common_origin) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned i = 0; i < kPacketSize; ++i) p.offset[axis][i] = p.moment[axis][i] = 0.0F;
    }
  }
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto middle = static_cast<float>(p.middle_origin[axis]);
    width.middle[axis] = middle;
    width.reach[axis] =
        static_cast<float>(p.spread) + c.radius + 0x1p-20F * __builtin_fabsf(middle);
    p.half[axis] += c.slope * kUp;
    for (unsigned i = 0; i < kPacketSize; ++i) {
      p.origin_low[axis][i] -= c.radius;
      p.origin_high[axis][i] += c.radius;
    }
  }
  return width;
}

/// Edge functions, den and det of the rays of a cone are within these of those of its lane's ray.
template <class F>
struct ConeMargins {
  F u;
  F v;
  F w;
  F den;
  F det;
};

/// `spread`: of the lanes' origins about that of the setup, a length.
GLIDAR_INLINE ConeMargins<Float8> margins_of(const BlockSetup& s, const Cones& c, float spread) {
  const Float8 slope = Float8::all(c.slope * kUp);
  const Float8 side = Float8::all((c.slope * spread + c.radius * (1.0F + c.slope)) * kUp);
  const Float8 n_size = length(s.n);
  const auto of_edge = [&](const Vector<Float8>& q, const Vector<Float8>& e) {
    return multiply_add(slope, length(q), multiply_add(side, length(e), s.bounds.edge));
  };
  return {of_edge(s.q2, s.corners.e2), of_edge(s.q1, s.corners.e1),
          of_edge(s.n - s.q1 - s.q2, s.corners.e2 - s.corners.e1),
          multiply_add(slope, n_size, s.bounds.den * Float8::all(1.6F)),
          multiply_add(Float8::all(c.radius * kUp), n_size, s.bounds.det * Float8::all(1.6F))};
}

/// Cones and triangles, one pair per lane of F.
template <class F>
struct ConeTest {
  typename F::Mask certain;   ///< all rays hit it
  typename F::Mask possible;  ///< some may
  F low;                      ///< bounds of the distance of hits
  F high;

  GLIDAR_INLINE ConeTest(F u, F v, F den, F det, const ConeMargins<F>& m) {
    const F zero = F::all(0.0F);
    const F w = den - u - v;
    // Edge functions that have one sign for all rays.
    const auto has_positive = max(max(u - m.u, v - m.v), w - m.w) > zero;
    const auto has_negative = min(min(u + m.u, v + m.v), w + m.w) < zero;
    const auto all_positive = min(min(u - m.u, v - m.v), w - m.w) > zero;
    const auto all_negative = max(max(u + m.u, v + m.v), w + m.w) < zero;
    const F least = magnitude(den) - m.den;
    const F most = magnitude(den) + m.den;
    const auto is_steep = least > m.den;  // the sign of den is certain
    const F ahead = flip_sign(det, den);
    const F above = ahead + m.det;
    const F below = select(is_steep, ahead, magnitude(ahead)) - m.det;
    low = max(below / most, zero) * F::all(kDown);
    high = select(is_steep, above / least, F::all(kFloatInfinity)) * F::all(kUp);
    certain = (all_positive | all_negative) & is_steep & (below > zero);
    possible = ~(has_positive & has_negative) & ~(is_steep & (above < zero));
  }
};

/// Forgets the hits behind the end of a cone.
GLIDAR_INLINE void forget_farther(Cones& c, unsigned lane, float end) {
  unsigned kept = 0;
  for (unsigned i = 0; i < c.count[lane]; ++i) {
    if (c.hit[lane][i].low <= end) c.hit[lane][kept++] = c.hit[lane][i];
  }
  c.count[lane] = kept;
}

GLIDAR_INLINE void overflow(Cones& c, RayPacket& p, unsigned lane) {
  c.overflowed |= 1U << lane;
  p.active &= ~(1U << lane);
  p.high[lane] = -kFloatInfinity;
}

/// Adds a hit to a cone and ends the cone: behind a certain hit at its `high`; else some way behind
/// it, where rays that miss it may have hit its neighbours. Rays that hit nothing before are traced
/// alone later.
GLIDAR_INLINE void add_hit(Cones& c, RayPacket& p, unsigned lane, const ConeHit& hit, float high) {
  if (c.count[lane] == kMaxConeHits) forget_farther(c, lane, p.high[lane]);
  if (c.count[lane] == kMaxConeHits) return overflow(c, p, lane);
  c.hit[lane][c.count[lane]++] = hit;
  const float behind = high - hit.low + 4.0F * (c.radius + c.slope * high);
  const float end = hit.is_certain ? high : high + behind;
  if (end < p.high[lane]) p.high[lane] = end;
}

/// A cluster and its triangles that are tested.
struct ConeLeaf {
  const TreeView& tree;
  std::uint32_t index;
  const TriangleCluster& cluster;

  /// Tests one cone, eight triangles at a time.
  GLIDAR_INLINE void test(RayPacket& p, Cones& c, unsigned lane) const {
    LocalOrigin origin = local_origin(p, lane, cluster);
    origin.reach += static_cast<double>(c.radius);
    if (!(origin.reach < kMaxReach)) return overflow(c, p, lane);
    const float scaled = scaled_reach(origin.reach);
    const Vector<Float8> d = {Float8::all(p.direction[0][lane]), Float8::all(p.direction[1][lane]),
                              Float8::all(p.direction[2][lane])};
    for (std::uint32_t b = 0; b < block_count(cluster.count); ++b) {
      const std::uint32_t block = cluster.first_block + b;
      const BlockSetup s = set_up(tree.blocks[block], cluster, origin.at, scaled);
      const ConeTest<Float8> test(dot(d, s.q2), dot(d, s.q1), dot(d, s.n), s.det,
                                  margins_of(s, c, 0.0F));
      const std::uint32_t possible = bits(test.possible) & present(cluster, b);
      add_hits(p, c, possible, test, [&](unsigned i) {
        return Place{lane, block * kBlockSize + i};
      });
    }
  }

  /// Tests many cones: first eight triangles at once with bounds of all cones, then the remaining
  /// triangles with sixteen cones.
  GLIDAR_INLINE void test_all(RayPacket& p, Cones& c, std::uint32_t lanes) const {
    LocalOrigin origin = local_origin(p.middle_origin, cluster, p.rounding);
    origin.reach += p.spread + static_cast<double>(c.radius);
    if (!(origin.reach < kMaxReach)) {
      return for_bits(lanes, [&](unsigned lane) { overflow(c, p, lane); });
    }
    const float scaled = scaled_reach(origin.reach);
    const auto spread = static_cast<float>(p.spread);
    const PacketBounds bounds(p, spread + c.radius, scaled);
    for (std::uint32_t b = 0; b < block_count(cluster.count); ++b) {
      const std::uint32_t block = cluster.first_block + b;
      const BlockSetup s = set_up(tree.blocks[block], cluster, origin.at, scaled);
      const std::uint32_t left = ~bits(bounds.are_outside(s)) & present(cluster, b);
      if (left == 0) continue;
      const ConeMargins<Float8> m = margins_of(s, c, kDiagonal * spread);
      BlockRows<LaneFloat, 21> rows;
      rows.set(0, s.q1);
      rows.set(3, s.q2);
      rows.set(6, s.n);
      rows.set(9, s.det);
      rows.set(10, s.corners.e1);
      rows.set(13, s.corners.e2);
      rows.set(16, m.u);
      rows.set(17, m.v);
      rows.set(18, m.w);
      rows.set(19, m.den);
      rows.set(20, m.det);
      for_bits(left, [&](unsigned i) { test_triangle(p, c, lanes, rows, block * kBlockSize + i); });
    }
  }

 private:
  static constexpr float kDiagonal = 1.7321F;  ///< of a cube

  struct Place {
    unsigned lane;
    std::uint32_t slot;
  };

  /// Tests sixteen cones with one triangle, as test_spread_triangle() tests rays.
  GLIDAR_INLINE void test_triangle(RayPacket& p, Cones& c, std::uint32_t lanes,
                                   const BlockRows<LaneFloat, 21>& rows, std::uint32_t slot) const {
    const unsigned i = slot % kBlockSize;
    const Vector<LaneFloat> n = rows.all3(6, i);
    const ConeMargins<LaneFloat> margins = {rows.all(16, i), rows.all(17, i), rows.all(18, i),
                                            rows.all(19, i), rows.all(20, i)};
    for (unsigned first = 0; first < kPacketSize; first += LaneFloat::kWidth) {
      const Vector<LaneFloat> d = lanes_of(p.direction, first);
      const Vector<LaneFloat> moment = lanes_of(p.moment, first);
      const LaneFloat u = dot(d, rows.all3(3, i)) + dot(moment, rows.all3(13, i));
      const LaneFloat v = dot(d, rows.all3(0, i)) - dot(moment, rows.all3(10, i));
      const LaneFloat det = rows.all(9, i) - dot(lanes_of(p.offset, first), n);
      const ConeTest<LaneFloat> test(u, v, dot(d, n), det, margins);
      const std::uint32_t possible = bits(test.possible & LaneFloat::mask(lanes >> first));
      add_hits(p, c, possible, test, [&](unsigned k) { return Place{first + k, slot}; });
    }
  }

  template <class F, class PlaceOf>
  GLIDAR_INLINE void add_hits(RayPacket& p, Cones& c, std::uint32_t possible,
                              const ConeTest<F>& test, const PlaceOf& place_of) const {
    if (possible == 0) return;
    const std::uint32_t certain = c.may_pass ? 0 : bits(test.certain);
    alignas(64) float low[F::kWidth];
    alignas(64) float high[F::kWidth];
    store(low, test.low);
    store(high, test.high);
    for_bits(possible, [&](unsigned i) {
      const Place place = place_of(i);
      if (low[i] > p.high[place.lane]) return;
      const bool is_certain = (certain >> i & 1U) != 0;
      add_hit(c, p, place.lane, {low[i], index, place.slot, is_certain}, high[i]);
    });
  }
};

/// Tests leaves of triangles.
struct ConeLeaves {
  const TreeView& tree;
  Cones& cones;
  ConeWidth width;

  GLIDAR_INLINE void operator()(std::uint32_t index, RayPacket& p, std::uint32_t lanes) const {
    constexpr int kFewLanes = 2;
    const ConeLeaf leaf{tree, index, tree.clusters[index]};
    if (__builtin_popcount(lanes) > kFewLanes) return leaf.test_all(p, cones, lanes);
    for_bits(lanes, [&](unsigned lane) { leaf.test(p, cones, lane); });
  }
};

/// Calls a function for leaves.
struct VisitedConeLeaves {
  VisitLeaf visit;
  void* context;
  ConeWidth width;

  GLIDAR_INLINE void operator()(std::uint32_t leaf, RayPacket& p, std::uint32_t lanes) const {
    visit(context, leaf, p, lanes);
  }
};

inline void trace_cones(const TreeView& tree, RayPacket& p, Cones& c) {
  const ConeWidth width = widen(p, c);
  traverse(tree, p, ConeLeaves{tree, c, width});
}

inline void visit_cone_leaves(const TreeView& tree, RayPacket& p, Cones& c, VisitLeaf visit,
                              void* context) {
  const ConeWidth width = widen(p, c);
  traverse(tree, p, VisitedConeLeaves{visit, context, width});
}

}  // namespace glidar::rays::GLIDAR_KERNEL
