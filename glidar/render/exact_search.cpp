// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/exact_search.hpp>

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

/// A box relative to the mesh's origin, as a box around it in the sensor's frame, metres; grown by
/// what single precision may be wrong by there.
Eigen::AlignedBox3d seen_box(const InstanceView& view, const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return {};
  const Eigen::Matrix<double, 3, 4> seen = sensor_from_object(view);
  const Eigen::Vector3d middle = seen * box.center().homogeneous();
  Eigen::Vector3d half = seen.leftCols<3>().cwiseAbs() * (0.5 * box.sizes());
  half.array() += kSinglePart * (middle.norm() + half.norm());
  return {middle - half, middle + half};
}

}  // namespace

void ExactSearch::prepare(const CastRequest& request) {
  const std::vector<Instance>& instances = resolver_.scene().instances;
  request_ = &request;
  has_overlaps_ = false;
  if (instances.size() < 2) return;
  if (!has_boxes_) {
    const std::vector<Mesh>& meshes = resolver_.scene().meshes;
    std::transform(meshes.begin(), meshes.end(), boxes_.begin(), box_of);
    has_boxes_ = true;
  }
  others_.resize(instances.size());
  seen_boxes_.resize(instances.size());
  order_.clear();
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    others_[i].clear();
    seen_boxes_[i] = seen_box(resolver_.view(i), boxes_[instances[i].mesh]);
    if (is_present(request, i) && !seen_boxes_[i].isEmpty()) order_.push_back(i);
  }
  const auto low = [&](std::uint32_t i) { return seen_boxes_[i].min().x(); };
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return low(a) != low(b) ? low(a) < low(b) : a < b;
  });
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const std::uint32_t a = order_[k];
    for (std::size_t next = k + 1; next < order_.size(); ++next) {
      const std::uint32_t b = order_[next];
      if (low(b) > seen_boxes_[a].max().x()) break;
      if (!seen_boxes_[a].intersects(seen_boxes_[b])) continue;
      others_[a].push_back(b);
      others_[b].push_back(a);
      has_overlaps_ = true;
    }
  }
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

Found ExactSearch::nearest(std::size_t beam) const {
  Judgement all = judgement(beam);
  const auto count = static_cast<std::uint32_t>(resolver_.scene().instances.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!is_present(*request_, i)) continue;
    for_triangles_on(all, i, [&](const Found& candidate) { all.consider(candidate); });
  }
  if (all.nearest.instance == kNoHit) return {};
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!is_present(*request_, i)) continue;
    for_triangles_on(all, i, [&](const Found& candidate) { all.consider_tie(candidate); });
  }
  return all.nearest;
}

bool ExactSearch::is_in_box(std::uint32_t instance, const Eigen::Vector3d& in_sensor_m) const {
  const Eigen::AlignedBox3d& box = boxes_[resolver_.scene().instances[instance].mesh];
  const InstanceView& view = resolver_.view(instance);
  const Eigen::Vector3d point =
      view.object_from_sensor * in_sensor_m / view.scale + view.sensor_in_object;
  const double room = kSinglePart * (in_sensor_m.norm() / view.scale + box.diagonal().norm());
  return ((point - box.min()).array() >= -room).all() &&
         ((point - box.max()).array() <= room).all();
}

std::uint32_t ExactSearch::overlapping(const HitBlock& block, const ExactBlock& exact) const {
  std::uint32_t mask = 0;
  for (std::uint32_t rest = block.mask; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(rest));
    const std::vector<std::uint32_t>& others = others_[block.instance[lane]];
    if (others.empty()) continue;
    const InstanceView& view = resolver_.view(block.instance[lane]);
    const Eigen::Vector3d point =
        exact.origin.get(lane) + exact.distance[lane] * exact.direction.get(lane);
    const Eigen::Vector3d seen =
        view.scale * (view.object_from_sensor.transpose() * (point - view.sensor_in_object));
    const bool is_shared = std::any_of(others.begin(), others.end(),
                                       [&](std::uint32_t i) { return is_in_box(i, seen); });
    mask |= static_cast<std::uint32_t>(is_shared) << lane;
  }
  return mask;
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

/// Calls take(candidate) for the one found and for the triangles that other instances have there.
template <class Take>
void ExactSearch::for_triangles_around(Judgement& judgement, const Found& found,
                                       const Take& take) const {
  const InstanceView& view = resolver_.view(found.instance);
  const ObjectRay ray = ray_in(view, request_->beams, judgement.beam);
  const TrianglePlane& plane = resolver_.plane(found.instance, found.primitive);
  judgement.slack_m = slack_of(found.instance, ray);
  take(found);
  for (const std::uint32_t i : others_[found.instance]) {
    for_triangles_at(judgement, i, view.scale * distance_to(plane, ray), take);
  }
}

Found ExactSearch::nearest_around(std::size_t beam, const Found& found) const {
  Judgement all = judgement(beam);
  for_triangles_around(all, found, [&](const Found& candidate) { all.consider(candidate); });
  if (all.nearest.instance == kNoHit) return found;
  for_triangles_around(all, found, [&](const Found& candidate) { all.consider_tie(candidate); });
  return all.nearest;
}

}  // namespace glidar
