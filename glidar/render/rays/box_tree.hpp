// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ray_tree.hpp>
#include <glidar/render/rays/split_tree.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::rays {

/// A tree over boxes that may move, one box per leaf.
class BoxTree {
 public:
  /// At least one box. Their indices are less than `count` and differ.
  void build(std::span<BoxReference> boxes, std::size_t count, ThreadPool& thread_pool);

  /// Moves the box of this index, and refits the boxes above it.
  void move(const BoxReference& box);

  /// True when the tree should be rebuilt because boxes moved: the areas of its nodes, and with
  /// them the expected search time, have doubled.
  [[nodiscard]] bool needs_rebuild() const { return area_ > 2.0 * built_area_; }

  [[nodiscard]] const std::vector<TreeNode>& nodes() const { return nodes_; }
  /// The index of the box in a leaf.
  [[nodiscard]] std::uint32_t index_in(std::uint32_t leaf) const { return index_of_leaf_[leaf]; }
  /// A sphere around all boxes.
  [[nodiscard]] const MeshSphere& sphere() const { return sphere_; }

 private:
  /// A child of a node.
  struct ChildSlot {
    std::uint32_t node;
    std::uint32_t child;
  };
  ChildSlot& slot_of(std::int32_t child);
  void find_slots(std::size_t count);

  std::vector<TreeNode> nodes_;
  std::vector<ChildSlot> slot_of_node_;  ///< unused for the root
  std::vector<ChildSlot> slot_of_box_;   ///< per index
  std::vector<std::uint32_t> index_of_leaf_;
  MeshSphere sphere_;
  double area_ = 0.0;  ///< of the boxes around the nodes, summed
  double built_area_ = 0.0;
};

}  // namespace glidar::rays
