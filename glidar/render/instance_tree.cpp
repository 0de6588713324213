// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/instance_tree.hpp>

#include <glidar/render/morton.hpp>

namespace glidar {
namespace {

using Box = InstanceTree::Box;

/// A mesh's box in the tree's frame, metres; grown by 16 roundings of single precision.
Box box_in(const Eigen::Matrix3d& tree_from_sensor, const InstanceView& view, const Box& box) {
  constexpr double kBoxRoundingPart = 0x1p-20;  // of distance and size, as in Overlaps
  const Eigen::Matrix<double, 3, 4> placed = tree_from_sensor * sensor_from_object(view);
  const Eigen::Vector3d middle = placed * box.center().homogeneous();
  Eigen::Vector3d half = placed.leftCols<3>().cwiseAbs() * (0.5 * box.sizes());
  const double reach = view.scale * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  half.array() += kBoxRoundingPart * (middle.norm() + half.norm() + reach);
  return {middle - half, middle + half};
}

std::uint64_t expand_step(double step) {
  return expand_bits(static_cast<std::uint64_t>(step));
}

}  // namespace

void InstanceTree::build(const CastRequest& request, const Resolver& resolver,
                         std::span<const Box> mesh_boxes) {
  const std::vector<Instance>& instances = resolver.scene().instances;
  const auto box_of = [&](std::uint32_t i) { return mesh_boxes[instances[i].mesh]; };
  order_.clear();
  double largest_m = -1.0;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_enabled(request, i) || box_of(i).isEmpty()) continue;
    order_.emplace_back(0, i);
    const double size_m = resolver.view(i).scale * box_of(i).diagonal().norm();
    if (!(size_m > largest_m)) continue;
    largest_m = size_m;
    tree_from_sensor_ = resolver.view(i).object_from_sensor;
  }
  boxes_.assign(instances.size(), Box());
  for (const auto& [code, i] : order_) {
    boxes_[i] = box_in(tree_from_sensor_, resolver.view(i), box_of(i));
  }
  sort_instances();
  build_nodes();
  find_shared();
}

/// By their Morton codes.
void InstanceTree::sort_instances() {
  constexpr double kMortonSteps = 65535.0;
  Box middles;
  for (const auto& [code, i] : order_) middles.extend(boxes_[i].center());
  const double size_m = order_.size() < 2 ? 0.0 : middles.sizes().maxCoeff();
  if (!(size_m > 0.0)) return;
  for (auto& [code, i] : order_) {
    const Eigen::Vector3d step = kMortonSteps / size_m * (boxes_[i].center() - middles.min());
    code = expand_step(step.x()) | (expand_step(step.y()) << 1U) | (expand_step(step.z()) << 2U);
  }
  std::sort(order_.begin(), order_.end());
}

void InstanceTree::build_nodes() {
  nodes_.clear();
  level_count_ = 0;
  if (order_.empty()) return;
  for (const auto& [code, i] : order_) nodes_.push_back(boxes_[i]);
  level_begin_[level_count_++] = 0;
  for (std::size_t begin = 0; nodes_.size() - begin > 1;) {
    const std::size_t end = nodes_.size();
    for (std::size_t i = begin; i < end; ++i) {
      if ((i - begin) % kFan == 0) nodes_.emplace_back();
      const Box child = nodes_[i];
      nodes_.back().extend(child);
    }
    level_begin_[level_count_++] = end;
    begin = end;
  }
}

void InstanceTree::find_shared() {
  shared_.assign(boxes_.size(), Box());
  has_overlaps_ = false;
  for (const auto& [code, i] : order_) {
    Box& shared = shared_[i];
    visit_near(boxes_[i], [&, i = i](std::uint32_t other) {
      if (other != i) shared.extend(boxes_[i].intersection(boxes_[other]));
      return !shared.contains(boxes_[i]);
    });
    has_overlaps_ = has_overlaps_ || !shared.isEmpty();
  }
}

}  // namespace glidar
