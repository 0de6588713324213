// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/exact_search.hpp>

#include <glidar/core/simd.hpp>

#include <algorithm>
#include <bit>
#include <limits>

namespace glidar {
namespace {

/// Single precision separates two surfaces only when they are farther apart than this part of
/// their distance and size: 16 roundings.
constexpr double kSinglePart = 0x1p-20;

Eigen::AlignedBox3d box_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : mesh.positions_m) box.extend(p.cast<double>());
  return box;
}

/// Where a block's beams hit, in the frame of a tree over the instances.
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

/// The lesser and the greater of two halves, lane by lane.
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

void ExactSearch::prepare(const CastRequest& request) {
  request_ = &request;
  if (!has_boxes_) {
    const std::vector<Mesh>& meshes = resolver_.scene().meshes;
    std::transform(meshes.begin(), meshes.end(), boxes_.begin(), box_of);
    has_boxes_ = true;
  }
  instances_.build(request, resolver_, boxes_);
}

Judgement ExactSearch::judgement(std::size_t beam) const {
  return {.resolver = resolver_, .beams = request_->beams, .beam = beam, .slack_m = 0.0};
}

double ExactSearch::slack_of(std::uint32_t instance, const ObjectRay& ray) const {
  const TriangleTree& tree = trees_.of_mesh(resolver_.scene().instances[instance].mesh);
  return slack(resolver_.view(instance).scale * (tree.reach() + ray.origin.norm()));
}

bool ExactSearch::stops_beam(const Judgement& judgement, const Found& candidate) const {
  return stops(resolver_, request_->beams, judgement.beam, request_->cull_back_faces, candidate);
}

/// Calls take(candidate) for an instance's triangles that the beam may meet before the nearest so
/// far.
template <class Take>
void ExactSearch::for_triangles_on(Judgement& judgement, std::uint32_t instance,
                                   const Take& take) const {
  const InstanceView& view = resolver_.view(instance);
  const ObjectRay ray = ray_in(view, request_->beams, judgement.beam);
  judgement.slack_m = slack_of(instance, ray);
  const double margin = 2.0 * judgement.slack_m / view.scale;
  double most = judgement.nearest_range_m / view.scale + margin;
  const auto visit = [&](std::uint32_t triangle) {
    const Found candidate{instance, triangle};
    if (!stops_beam(judgement, candidate)) return;
    take(candidate);
    most = judgement.nearest_range_m / view.scale + margin;
  };
  trees_.of_mesh(resolver_.scene().instances[instance].mesh).visit_along(ray, margin, most, visit);
}

/// A beam in the frame of the tree over the instances.
ObjectRay ExactSearch::ray_in_tree(std::size_t beam) const {
  const Beams& beams = request_->beams;
  const Eigen::Matrix3d& turn = instances_.tree_from_sensor();
  ObjectRay ray{Eigen::Vector3d::Zero(), turn * beams.directions[beam]};
  if (!beams.origins_m.empty()) ray.origin = turn * beams.origins_m[beam];
  return ray;
}

/// Calls take(candidate) for the triangles of all instances that the beam may meet before the
/// nearest so far.
template <class Take>
void ExactSearch::for_triangles_ahead(Judgement& judgement, const Take& take) const {
  const ObjectRay ray = ray_in_tree(judgement.beam);
  instances_.visit_along(ray, judgement.nearest_range_m, [&](std::uint32_t i) {
    for_triangles_on(judgement, i, take);
    return true;
  });
}

Found ExactSearch::nearest(std::size_t beam) const {
  Judgement all = judgement(beam);
  for_triangles_ahead(all, [&](const Found& candidate) { all.consider(candidate); });
  if (all.nearest.instance == kNoHit) return {};
  for_triangles_ahead(all, [&](const Found& candidate) { all.consider_tie(candidate); });
  return all.nearest;
}

/// Which of these lanes' points are in the box of one of an instance's triangles. `around` holds
/// them all, in the tree's frame: most blocks are far from all triangles.
std::uint32_t ExactSearch::lanes_at(std::uint32_t instance, std::uint32_t lanes,
                                    const Eigen::AlignedBox3d& around,
                                    const Lanes3<double>& in_tree) const {
  const InstanceView& view = resolver_.view(instance);
  const TriangleTree& tree = trees_.of_mesh(resolver_.scene().instances[instance].mesh);
  const Eigen::Matrix3d turn =
      view.object_from_sensor * instances_.tree_from_sensor().transpose() / view.scale;
  const Eigen::Vector3d middle = turn * around.center();
  const Eigen::Vector3d half = turn.cwiseAbs() * (0.5 * around.sizes());
  const double room = kSinglePart * (middle.norm() + half.norm() + tree.reach());
  const Eigen::Vector3d place = view.sensor_in_object + middle;
  if (!tree.has_any_near({place - half, place + half}, room)) return 0;
  std::uint32_t found = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(lanes));
    const Eigen::Vector3d point = view.sensor_in_object + turn * in_tree.get(lane);
    found |= static_cast<std::uint32_t>(tree.has_any_near({point, point}, room)) << lane;
  }
  return found;
}

std::uint32_t ExactSearch::overlapping(const HitBlock& block, const BeamBlock& beams,
                                       const ExactBlock& exact) const {
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

/// Calls take(candidate) for an instance's triangles around a point of the beam.
template <class Take>
void ExactSearch::for_triangles_at(Judgement& judgement, std::uint32_t instance, double range_m,
                                   const Take& take) const {
  const InstanceView& view = resolver_.view(instance);
  const ObjectRay ray = ray_in(view, request_->beams, judgement.beam);
  const TriangleTree& tree = trees_.of_mesh(resolver_.scene().instances[instance].mesh);
  const double distance = range_m / view.scale;
  const double room = kSinglePart * (distance + tree.reach());
  judgement.slack_m = slack_of(instance, ray);
  const auto visit = [&](std::uint32_t triangle) {
    const Found candidate{instance, triangle};
    if (stops_beam(judgement, candidate)) take(candidate);
  };
  tree.visit_at(ray.origin + distance * ray.direction, room, visit);
}

/// Calls take(candidate) for the triangles that instances other than the one found have at a point
/// of the beam.
template <class Take>
void ExactSearch::for_triangles_around(Judgement& judgement, const Found& found, double range_m,
                                       const Take& take) const {
  const ObjectRay ray = ray_in_tree(judgement.beam);
  const Eigen::Vector3d point = ray.origin + range_m * ray.direction;
  instances_.visit_near({point, point}, [&](std::uint32_t i) {
    if (i != found.instance) for_triangles_at(judgement, i, range_m, take);
    return true;
  });
}

Found ExactSearch::nearest_around(std::size_t beam, const Found& found) const {
  const InstanceView& view = resolver_.view(found.instance);
  const ObjectRay ray = ray_in(view, request_->beams, beam);
  const double range_m =
      view.scale * distance_to(resolver_.plane(found.instance, found.primitive), ray);
  const double slack_m = slack_of(found.instance, ray);
  Judgement all = judgement(beam);
  all.slack_m = slack_m;
  all.consider(found);
  bool is_alone = true;
  for_triangles_around(all, found, range_m, [&](const Found& candidate) {
    all.consider(candidate);
    is_alone = false;
  });
  if (is_alone || all.nearest.instance == kNoHit) return found;
  for_triangles_around(all, found, range_m,
                       [&](const Found& candidate) { all.consider_tie(candidate); });
  all.slack_m = slack_m;
  all.consider_tie(found);
  return all.nearest;
}

}  // namespace glidar
