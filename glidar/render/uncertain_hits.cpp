// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/uncertain_hits.hpp>

#include <glidar/math/simd.hpp>
#include <glidar/render/common/triangle_blocks.hpp>
#include <glidar/render/corners.hpp>

namespace glidar {
namespace {

// An area is a sum of six products in single precision; its error is below this fraction of the
// squared distance to the farthest corner.
constexpr float kAreaRounding = 0x1p-20F;

GLIDAR_SIMD std::uint32_t outside(const ExactHits& e) {
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const CornerAreas areas = areas_around(e, e.corners, i);
    const float ab = areas.at_0 < areas.at_1 ? areas.at_0 : areas.at_1;
    const float smallest = ab < areas.at_2 ? ab : areas.at_2;
    const int inside = static_cast<int>(smallest >= kAreaRounding * areas.reach_squared);
    const int ahead = static_cast<int>(e.distance[i] > 0.0);
    bits[i] = static_cast<std::uint32_t>((inside & ahead) ^ 1) << i;
  }
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) mask |= bits[i];
  return mask;
}

}  // namespace

std::uint32_t uncertain_lanes(const Resolver& resolver, const HitBlock& block, ExactHits& exact) {
  resolver.gather_corners(block, exact);
  return outside(exact) & block.mask;
}

bool are_hits_of_rule(const Resolver& resolver, const HitBlock& block, const ExactHits& exact) {
  bool are_hits = true;
  for_lanes(block.mask, [&](unsigned i) {
    const HitRay ray = make_hit_ray(exact.origin.get(i), exact.direction.get(i));
    const Mesh& mesh = resolver.mesh(block.instance[i]);
    are_hits = are_hits && hit_distance(ray, corners_of(mesh, block.primitive[i])) > 0.0;
  });
  return are_hits;
}

}  // namespace glidar
