// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/hit_rule.hpp>

#include <algorithm>
#include <cmath>

// The arithmetic of hit_distance(), for every method of computing the error of a product: all give
// the same bits.
namespace glidar::hit_arithmetic {

/// A corner in the sheared frame, in which the ray is the z axis.
struct Sheared {
  double x;
  double y;
  double z;
};

inline double zero_if_tiny(double value) {
  return std::abs(value) < kMinHitCoordinate ? 0.0 : value;
}

inline Sheared shear(const HitRay& ray, const std::array<float, 3>& corner) {
  const double x = double{corner[ray.axis[0]]} - ray.origin[ray.axis[0]];
  const double y = double{corner[ray.axis[1]]} - ray.origin[ray.axis[1]];
  const double z = double{corner[ray.axis[2]]} - ray.origin[ray.axis[2]];
  return {zero_if_tiny(x - ray.shear_x * z), zero_if_tiny(y - ray.shear_y * z), zero_if_tiny(z)};
}

/// p.x q.y - p.y q.x with the exact sign and two roundings of relative error: M. Cornea,
/// J. Harrison, P. T. P. Tang, "Scientific Computing on Itanium-based Systems" (2002), analysed by
/// C.-P. Jeannerod, "A Radix-Independent Error Analysis of the Cornea-Harrison-Tang Method", ACM
/// TOMS 42(3), 2016. The sign is exact: rounding is monotonic, so the products' difference has the
/// true sign unless it is zero, and then the errors' difference is exact. The errors can only
/// overturn neighbouring products, for which both differences are exact.
template <class Product>
double determinant(const Sheared& p, const Sheared& q) {
  const double first = p.x * q.y;
  const double second = p.y * q.x;
  const double error = Product::error(p.x, q.y, first) - Product::error(p.y, q.x, second);
  return (first - second) + error;
}

/// Bounds the change of the determinant by the rounding of two corners, in roundings: the error of
/// each coordinate is below 2^-52 of |x| + |y| + |z|.
inline double determinant_margin(const Sheared& p, const Sheared& q) {
  const double width_p = std::abs(p.x) + std::abs(p.y);
  const double width_q = std::abs(q.x) + std::abs(q.y);
  return width_p * (width_q + std::abs(q.z)) + width_q * (width_p + std::abs(p.z));
}

/// The sum of three numbers, the same for every order of them.
inline double sum_in_any_order(double a, double b, double c) {
  const double low = std::min(a, b);
  const double high = std::max(a, b);
  const double middle = std::max(low, std::min(high, c));
  return (std::min(low, c) + std::max(high, c)) + middle;
}

/// z where the axis crosses the segment from p to q, which it must do. Only these corners matter,
/// so all triangles at the edge get the same value, and at a vertex it is exactly z of the vertex.
inline double depth_on_edge(const Sheared& p, const Sheared& q) {
  const bool is_wide = std::abs(p.x) + std::abs(q.x) >= std::abs(p.y) + std::abs(q.y);
  const double to_p = std::abs(is_wide ? p.x : p.y);
  const double to_q = std::abs(is_wide ? q.x : q.y);
  if (to_p == 0.0) return p.z;
  if (to_q == 0.0) return q.z;
  return (p.z * to_q + q.z * to_p) / (to_p + to_q);
}

/// |x| + |y| + |z| of (p - o) x (q - o), twice the area of a triangle or a little more.
inline double area_at(const Sheared& o, const Sheared& p, const Sheared& q) {
  const Sheared e = {p.x - o.x, p.y - o.y, p.z - o.z};
  const Sheared f = {q.x - o.x, q.y - o.y, q.z - o.z};
  return std::abs(e.y * f.z - e.z * f.y) + std::abs(e.z * f.x - e.x * f.z) +
         std::abs(e.x * f.y - e.y * f.x);
}

/// The largest of three numbers.
inline double largest(double a, double b, double c) {
  return std::max(std::max(a, b), c);
}

/// True for an origin on the triangle, within rounding: not all corners are on one side of
/// it, and `volume`, its distance from the plane times twice the area, is within the rounding error
/// of zero. The second bound is for slivers, whose volume is always small: the distance itself
/// must be within kTouchingHeight of the corners' size.
inline bool is_touching(const Sheared& a, const Sheared& b, const Sheared& c, double volume) {
  if (std::min(std::min(a.z, b.z), c.z) > 0.0 || largest(a.z, b.z, c.z) < 0.0) return false;
  const double margin = sum_in_any_order(determinant_margin(c, b) * std::abs(a.z),
                                         determinant_margin(a, c) * std::abs(b.z),
                                         determinant_margin(b, a) * std::abs(c.z));
  const auto size = [](const Sheared& p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); };
  const double area = largest(area_at(a, b, c), area_at(b, c, a), area_at(c, a, b));
  return std::abs(volume) <= kTouching * margin &&
         std::abs(volume) <= kTouchingHeight * largest(size(a), size(b), size(c)) * area;
}

/// hit_distance() by the given product.
template <class Product>
double distance(const HitRay& ray, const HitTriangle& triangle) {
  const Sheared a = shear(ray, triangle.a);
  const Sheared b = shear(ray, triangle.b);
  const Sheared c = shear(ray, triangle.c);
  const double u = determinant<Product>(c, b);
  const double v = determinant<Product>(a, c);
  const double w = determinant<Product>(b, a);
  const bool has_negative = u < 0.0 || v < 0.0 || w < 0.0;
  const bool has_positive = u > 0.0 || v > 0.0 || w > 0.0;
  if (has_negative == has_positive) return 0.0;  // outside, or edge-on: all are zero
  const double volume = sum_in_any_order(u * a.z, v * b.z, w * c.z);
  if (is_touching(a, b, c, volume)) return 0.0;
  double depth;
  if (w == 0.0) {
    depth = depth_on_edge(a, b);
  } else if (u == 0.0) {
    depth = depth_on_edge(b, c);
  } else if (v == 0.0) {
    depth = depth_on_edge(c, a);
  } else {
    depth = volume / sum_in_any_order(u, v, w);
  }
  const double distance = depth / ray.along;
  return distance > 0.0 ? distance : 0.0;
}

}  // namespace glidar::hit_arithmetic
