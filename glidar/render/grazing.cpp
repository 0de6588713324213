// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/grazing.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/block_kernel.hpp>
#include <glidar/render/common/triangle_blocks.hpp>

#include <cmath>

namespace glidar {
namespace {

/// Sets the plane of a triangle without area, which a beam hits only by rounding: it contains the
/// longest edge and faces the beam as far as possible.
void set_facing_plane(unsigned lane, const HitTriangle& triangle, ExactHits& exact) {
  const auto vector = [](const std::array<float, 3>& p) {
    return Eigen::Vector3d(double{p[0]}, double{p[1]}, double{p[2]});
  };
  const Eigen::Vector3d a = vector(triangle.a);
  Eigen::Vector3d edge = vector(triangle.b) - a;
  const Eigen::Vector3d other = vector(triangle.c) - a;
  if (other.squaredNorm() > edge.squaredNorm()) edge = other;
  const Eigen::Vector3d d = exact.direction.get(lane);
  const Eigen::Vector3d along = edge.normalized();
  const Eigen::Vector3d normal = (along * along.dot(d) - d).normalized();
  exact.normal.set(lane, normal);
  exact.offset[lane] = normal.dot(a);
  exact.cosine[lane] = normal.dot(d);
}

/// 0 where the plane is accurate enough for a lane, else 1. An integer, so that loops vectorise.
[[gnu::always_inline]] inline unsigned is_uncertain(const ExactHits& exact, unsigned lane) {
  const auto is_steep = static_cast<unsigned>(std::abs(exact.cosine[lane]) > kGrazing);
  const auto is_ahead = static_cast<unsigned>(exact.distance[lane] > 0.0);
  return (is_steep & is_ahead) ^ 1U;
}

/// True when the planes are accurate enough for all lanes.
GLIDAR_SIMD bool are_all_certain(const ExactHits& exact) {
  unsigned unsure = 0;
  for (unsigned i = 0; i < kLanes; ++i) unsure |= is_uncertain(exact, i);
  return unsure == 0;
}

}  // namespace

void intersect_grazing(const Resolver& resolver, const HitBlock& block, ExactHits& exact) {
  if (are_all_certain(exact)) return;
  std::uint32_t unsure = 0;
  for (unsigned i = 0; i < kLanes; ++i) unsure |= is_uncertain(exact, i) << i;
  for_lanes(unsure & block.mask, [&](unsigned i) {
    const HitRay ray = make_hit_ray(exact.origin.get(i), exact.direction.get(i));
    const HitTriangle corners = corners_of(resolver.mesh(block.instance[i]), block.primitive[i]);
    if (std::isnan(exact.offset[i])) set_facing_plane(i, corners, exact);
    const double distance = hit_distance(ray, corners);
    if (distance > 0.0) exact.distance[i] = distance;
  });
}

}  // namespace glidar
