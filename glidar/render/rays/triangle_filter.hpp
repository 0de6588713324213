// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/triangle_blocks.hpp>

// The filter in single precision: it rejects and accepts triangles where its error bounds allow,
// and bounds their distances. docs/internals/ray-casting.md derives the bounds. u = 2^-24.
namespace glidar::rays::GLIDAR_KERNEL {

template <class F>
struct Vector {
  F x;
  F y;
  F z;
};

template <class F>
GLIDAR_INLINE F dot(const Vector<F>& a, const Vector<F>& b) {
  return multiply_add(a.x, b.x, multiply_add(a.y, b.y, a.z * b.z));
}

template <class F>
GLIDAR_INLINE F determinant(F a, F b, F c, F d) {
  return multiply_subtract(a, b, c * d);
}

template <class F>
GLIDAR_INLINE Vector<F> cross(const Vector<F>& a, const Vector<F>& b) {
  return {determinant(a.y, b.z, a.z, b.y), determinant(a.z, b.x, a.x, b.z),
          determinant(a.x, b.y, a.y, b.x)};
}

template <class F>
GLIDAR_INLINE Vector<F> operator-(const Vector<F>& a, const Vector<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class F>
GLIDAR_INLINE Vector<F> magnitude(const Vector<F>& a) {
  return {magnitude(a.x), magnitude(a.y), magnitude(a.z)};
}

template <class F>
GLIDAR_INLINE Vector<F> flip_sign(const Vector<F>& a, F sign) {
  return {flip_sign(a.x, sign), flip_sign(a.y, sign), flip_sign(a.z, sign)};
}

/// |x| + |y| + |z|
template <class F>
GLIDAR_INLINE F sum_of_sizes(const Vector<F>& a) {
  return magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
}

/// For clusters beyond this distance, products might overflow: there the rule decides everything.
inline constexpr double kMaxReach = 0x1p36;
/// Added to distances and areas so that their bounds also cover underflow. Triangles below some
/// nanometres are re-tested more often.
inline constexpr double kReachMargin = 0x1p-40;
inline constexpr float kAreaMargin = 0x1p-60F;

/// 24 u L, rounded up; L: the largest distance of a corner, in the largest coordinate.
GLIDAR_INLINE float scaled_reach(double reach) {
  return static_cast<float>(24.01 * 0x1p-24 * (reach + kReachMargin));
}

/// Corners of triangles relative to their cluster's centre.
template <class F>
struct Corners {
  Vector<F> a;   ///< first corner
  Vector<F> e1;  ///< from it to the second
  Vector<F> e2;  ///< from it to the third
};

/// Bounds of the errors of edge functions, of det and of den.
template <class F>
struct ErrorBounds {
  F edge;
  F det;
  F den;
};

/// Eight triangles as seen from an origin A away. For a direction d, the edge functions are
/// v = d.q1, u = d.q2 and w = den - u - v with den = d.n; the plane is at the distance det / den.
struct BlockSetup {
  Corners<Float8> corners;
  Vector<Float8> q1;  ///< A x e1
  Vector<Float8> q2;  ///< e2 x A
  Vector<Float8> n;   ///< e1 x e2
  Float8 det;         ///< A.n
  ErrorBounds<Float8> bounds;
};

/// The edge functions of rays and triangles.
template <class F>
struct EdgeTest {
  F lowest;
  F highest;
  F den;

  /// For rays that certainly pass inside of all edges.
  GLIDAR_INLINE static EdgeTest inside(F d) {
    const F infinite = F::all(__builtin_huge_valf());
    EdgeTest test;
    test.lowest = infinite;
    test.highest = infinite;
    test.den = d;
    return test;
  }

  GLIDAR_INLINE EdgeTest(F u, F v, F d) : den(d) {
    const F w = d - u - v;
    lowest = min(min(u, v), w);
    highest = max(max(u, v), w);
  }

 private:
  EdgeTest() = default;
};

GLIDAR_INLINE Vector<Float8> corner_rows(const float (&rows)[3][kBlockSize]) {
  return {Float8::load(rows[0]), Float8::load(rows[1]), Float8::load(rows[2])};
}

GLIDAR_INLINE Corners<Float8> corners_in(const TriangleBlock& block,
                                         const TriangleCluster& cluster) {
  const Vector<Float8> p = corner_rows(block.corner[0]);
  const Vector<Float8> centre = {Float8::all(cluster.centre[0]), Float8::all(cluster.centre[1]),
                                 Float8::all(cluster.centre[2])};
  return {p - centre, corner_rows(block.corner[1]) - p, corner_rows(block.corner[2]) - p};
}

/// `a`: the first corners from the origin; `scaled`: see scaled_reach().
GLIDAR_INLINE BlockSetup set_up(const Corners<Float8>& corners, const Vector<Float8>& a,
                                float scaled) {
  BlockSetup s;
  s.corners = corners;
  s.q1 = cross(a, s.corners.e1);
  s.q2 = cross(s.corners.e2, a);
  s.n = cross(s.corners.e1, s.corners.e2);
  s.det = dot(a, s.n);
  const Float8 s1 = sum_of_sizes(s.corners.e1);
  const Float8 s2 = sum_of_sizes(s.corners.e2);
  const Float8 area = multiply_add(s1, s2, Float8::all(kAreaMargin));
  const Float8 reach = Float8::all(scaled);
  s.bounds.edge = multiply_add(reach, s1 + s2, Float8::all(24.0F * 0x1p-24F) * area);
  s.bounds.det = reach * area * Float8::all(0.5F);
  s.bounds.den = area * Float8::all(10.0F * 0x1p-24F);
  return s;
}

GLIDAR_INLINE BlockSetup set_up(const TriangleBlock& block, const TriangleCluster& cluster,
                                const float (&origin)[3], float scaled) {
  const Corners<Float8> corners = corners_in(block, cluster);
  const Vector<Float8> from = {Float8::all(origin[0]), Float8::all(origin[1]),
                               Float8::all(origin[2])};
  return set_up(corners, corners.a - from, scaled);
}

/// Bounds of a ray's nearest distance, as in RayPacket.
template <class F>
struct Interval {
  F low;
  F high;
  F near_low;
  F near_high;
};

/// Classification of triangles that are not certainly outside.
template <class F>
struct FilterResult {
  typename F::Mask accepted;   ///< certainly hit, and certainly nearer
  typename F::Mask uncertain;  ///< to be re-tested by the rule
  F low;                       ///< bounds of the distance
  F high;
};

template <class F>
GLIDAR_INLINE FilterResult<F> classify(const EdgeTest<F>& edges, typename F::Mask candidates, F det,
                                       const ErrorBounds<F>& bounds, const Interval<F>& best) {
  const F den = magnitude(edges.den);
  const auto is_known = den > bounds.den * F::all(4.0F);
  const F inverse = F::all(1.0F) / edges.den;
  const F t = det * inverse;
  const F size = magnitude(t);
  F error = multiply_add(size, bounds.den, bounds.det) * F::all(1.5F) * magnitude(inverse);
  error = multiply_add(size, F::all(0x1p-21F), error);
  FilterResult<F> result;
  result.low = t - error;
  result.high = t + error;
  const auto is_farther = (result.low > best.high) | (result.high < best.near_low);
  const auto rest = candidates & ~(is_known & is_farther);
  const auto is_inside = (edges.lowest > bounds.edge) | (edges.highest < -bounds.edge);
  const auto is_nearer = (result.high < best.low) & (result.low > best.near_high);
  result.accepted = rest & is_known & is_inside & is_nearer;
  result.uncertain = rest & ~result.accepted;
  return result;
}

}  // namespace glidar::rays::GLIDAR_KERNEL
