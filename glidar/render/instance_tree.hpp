// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace glidar {

/// A tree of bounding boxes over the instances of one cast, eight boxes to a node. It finds the
/// instances near a point without a test of each.
///
/// The tree has its own frame, in metres: the sensor's origin and the axes of the largest instance.
/// Boxes of objects that are aligned with it therefore stay small.
class InstanceTree {
 public:
  using Box = Eigen::AlignedBox3d;

  /// Builds the tree over the enabled instances. The resolver has the cast's poses; `mesh_boxes`
  /// are relative to the origins of the meshes. Boxes are grown by the rounding of single
  /// precision.
  void build(const CastRequest& request, const Resolver& resolver, std::span<const Box> mesh_boxes);

  [[nodiscard]] const Eigen::Matrix3d& tree_from_sensor() const { return tree_from_sensor_; }

  /// True when boxes of instances overlap.
  [[nodiscard]] bool has_overlaps() const { return has_overlaps_; }

  /// The part of an instance's box that the boxes of others overlap; empty: none does.
  [[nodiscard]] const Box& shared(std::uint32_t instance) const { return shared_[instance]; }

  /// Calls visit(instance) for every instance whose box intersects this one, until it returns
  /// false.
  template <class Visit>
  void visit_near(const Box& box, const Visit& visit) const {
    if (!order_.empty()) visit_node(level_count_ - 1, 0, box, visit);
  }

 private:
  static constexpr std::size_t kFan = 8;
  static constexpr std::size_t kMaxLevels = 12;  // for 2^32 instances

  void sort_instances();
  void build_nodes();
  void find_shared();

  /// False when visit() has ended the search.
  template <class Visit>
  bool visit_node(std::size_t level, std::size_t index, const Box& box, const Visit& visit) const {
    if (!nodes_[level_begin_[level] + index].intersects(box)) return true;
    if (level == 0) return visit(order_[index].second);
    const std::size_t below = level_begin_[level] - level_begin_[level - 1];
    const std::size_t end = std::min(below, (index + 1) * kFan);
    for (std::size_t i = index * kFan; i < end; ++i) {
      if (!visit_node(level - 1, i, box, visit)) return false;
    }
    return true;
  }

  Eigen::Matrix3d tree_from_sensor_ = Eigen::Matrix3d::Identity();
  bool has_overlaps_ = false;
  std::vector<Box> boxes_;   ///< per instance; empty: not enabled
  std::vector<Box> shared_;  ///< per instance
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order_;  ///< Morton code, instance
  std::vector<Box> nodes_;                                      ///< level by level from the leaves
  std::array<std::size_t, kMaxLevels> level_begin_ = {};
  std::size_t level_count_ = 0;
};

}  // namespace glidar
