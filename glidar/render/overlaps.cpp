// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/overlaps.hpp>

#include <glidar/math/simd.hpp>

#include <bit>
#include <limits>

namespace glidar {
namespace {

/// Single precision separates two surfaces only when their distance exceeds this fraction of their
/// range and size: 16 roundings.
constexpr double kSingleRounding = 0x1p-20;

/// The hit points of a block, in the frame of a tree over the instances.
GLIDAR_SIMD void find_points(const BeamBlock& beams, const Lanes<double>& range_m,
                             const Eigen::Matrix3d& tree_from_sensor, Lanes3<double>& points) {
  Lanes3<double> p;
  for (unsigned i = 0; i < kLanes; ++i) p.x[i] = range_m[i] * beams.direction.x[i];
  for (unsigned i = 0; i < kLanes; ++i) p.y[i] = range_m[i] * beams.direction.y[i];
  for (unsigned i = 0; i < kLanes; ++i) p.z[i] = range_m[i] * beams.direction.z[i];
  if (beams.has_origins) {
    for (unsigned i = 0; i < kLanes; ++i) p.x[i] += beams.origin_m.x[i];
    for (unsigned i = 0; i < kLanes; ++i) p.y[i] += beams.origin_m.y[i];
    for (unsigned i = 0; i < kLanes; ++i) p.z[i] += beams.origin_m.z[i];
  }
  rotate(tree_from_sensor, p, points);
}

/// A bit for every lane whose point is in the box.
GLIDAR_SIMD std::uint32_t lanes_in(const Eigen::AlignedBox3d& box, const Lanes3<double>& p) {
  const Eigen::Vector3d& low = box.min();
  const Eigen::Vector3d& high = box.max();
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const int x = static_cast<int>(p.x[i] >= low.x()) & static_cast<int>(p.x[i] <= high.x());
    const int y = static_cast<int>(p.y[i] >= low.y()) & static_cast<int>(p.y[i] <= high.y());
    const int z = static_cast<int>(p.z[i] >= low.z()) & static_cast<int>(p.z[i] <= high.z());
    bits[i] = static_cast<std::uint32_t>(x & y & z) << i;
  }
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) mask |= bits[i];
  return mask;
}

/// Minimum and maximum of two halves, lane by lane.
template <unsigned kHalf>
inline void fold(Lanes<double>& lows, Lanes<double>& highs) {
  for (unsigned i = 0; i < kHalf; ++i) {
    lows[i] = lows[i + kHalf] < lows[i] ? lows[i + kHalf] : lows[i];
    highs[i] = highs[i + kHalf] > highs[i] ? highs[i + kHalf] : highs[i];
  }
}

/// The extent of these lanes' points along one axis.
[[gnu::always_inline]] inline void find_extent(const Lanes<double>& p, std::uint32_t lanes,
                                               double& low, double& high) {
  static_assert(kLanes == 16);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Lanes<double> lows;
  Lanes<double> highs;
  for (unsigned i = 0; i < kLanes; ++i) {
    const bool is_in = (lanes & (1U << i)) != 0;
    lows[i] = is_in ? p[i] : kNone;
    highs[i] = is_in ? p[i] : -kNone;
  }
  fold<8>(lows, highs);
  fold<4>(lows, highs);
  fold<2>(lows, highs);
  fold<1>(lows, highs);
  low = lows[0];
  high = highs[0];
}

GLIDAR_SIMD Eigen::AlignedBox3d box_around(const Lanes3<double>& p, std::uint32_t lanes) {
  Eigen::AlignedBox3d box;
  find_extent(p.x, lanes, box.min().x(), box.max().x());
  find_extent(p.y, lanes, box.min().y(), box.max().y());
  find_extent(p.z, lanes, box.min().z(), box.max().z());
  return box;
}

/// A bit for every lane that hit the instance.
std::uint32_t lanes_on(std::uint32_t instance, const HitBlock& block) {
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) {
    mask |= static_cast<std::uint32_t>(block.instance[i] == instance) << i;
  }
  return mask;
}

}  // namespace

Overlaps::Overlaps(const Resolver& resolver, const rays::SceneTrees& trees)
    : resolver_(resolver), trees_(trees) {
  for (std::uint32_t mesh = 0; mesh < resolver.scene().meshes.size(); ++mesh) {
    boxes_.push_back(box_of(trees.of_mesh(mesh)));
  }
}

void Overlaps::prepare(const CastRequest& request) {
  instances_.build(request, resolver_, boxes_);
}

/// The lanes whose points are in the box of one of the instance's triangles. `around` contains all
/// points, in the tree's frame; it rejects most blocks at once.
std::uint32_t Overlaps::lanes_at(std::uint32_t instance, std::uint32_t lanes,
                                 const Eigen::AlignedBox3d& around,
                                 const Lanes3<double>& in_tree) const {
  const InstanceView& view = resolver_.view(instance);
  const rays::MeshTree& tree = trees_.of_instance(instance);
  const Eigen::Matrix3d rotation =
      view.object_from_sensor * instances_.tree_from_sensor().transpose() / view.scale;
  const Eigen::Vector3d middle = rotation * around.center();
  const Eigen::Vector3d half = rotation.cwiseAbs() * (0.5 * around.sizes());
  const double margin = kSingleRounding * (middle.norm() + half.norm() + trees_.reach(instance));
  const Eigen::Vector3d position = view.sensor_in_object + middle;
  if (!has_triangle_near(tree, {position - half, position + half}, margin)) return 0;
  std::uint32_t found = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    const Eigen::Vector3d point = view.sensor_in_object + rotation * in_tree.get(lane);
    found |= static_cast<std::uint32_t>(has_triangle_near(tree, {point, point}, margin)) << lane;
  }
  return found;
}

std::uint32_t Overlaps::lanes_near(const HitBlock& block, const BeamBlock& beams,
                                   const ExactHits& exact) const {
  Lanes<double> range_m;
  for (unsigned i = 0; i < kLanes; ++i) {
    range_m[i] = exact.distance[i] * resolver_.view(block.instance[i]).scale;
  }
  Lanes3<double> points;
  find_points(beams, range_m, instances_.tree_from_sensor(), points);
  std::uint32_t near = 0;
  for (std::uint32_t rest = block.mask; rest != 0;) {
    const std::uint32_t hit = block.instance[static_cast<unsigned>(std::countr_zero(rest))];
    const std::uint32_t lanes = lanes_on(hit, block) & rest;
    const Eigen::AlignedBox3d& shared = instances_.shared(hit);
    if (!shared.isEmpty()) near |= lanes_in(shared, points) & lanes;
    rest &= ~lanes;
  }
  if (near == 0) return 0;
  std::uint32_t found = 0;
  const Eigen::AlignedBox3d around = box_around(points, near);
  instances_.visit_near(around, [&](std::uint32_t i) {
    const std::uint32_t lanes = near & ~found & ~lanes_on(i, block);
    if (lanes != 0) found |= lanes_at(i, lanes, around, points);
    return found != near;
  });
  return found;
}

}  // namespace glidar
