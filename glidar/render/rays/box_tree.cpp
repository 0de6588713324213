// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/box_tree.hpp>

#include <glidar/render/rays/collapse_tree.hpp>

#include <algorithm>

namespace glidar::rays {
namespace {

/// The box around a node's children; missing ones have empty boxes.
SplitNode box_around(const TreeNode& node) {
  SplitNode box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = *std::min_element(node.low[axis], node.low[axis] + 8);
    box.high[axis] = *std::max_element(node.high[axis], node.high[axis] + 8);
  }
  return box;
}

}  // namespace

void BoxTree::build(std::span<BoxReference> boxes, std::size_t count, ThreadPool& thread_pool) {
  const SplitOptions options = {.leaf_size = 1, .max_depth = kMaxTreeDepth - 2};
  const SplitTree split = build_split_tree(boxes, options, thread_pool);
  sphere_ = sphere_of(split.nodes[0]);
  std::vector<LeafRange> leaves;
  collapse_tree(split.view(), nodes_, leaves);
  index_of_leaf_.clear();
  for (const LeafRange& leaf : leaves) index_of_leaf_.push_back(boxes[leaf.first].index);
  find_slots(count);
  area_ = 0.0;
  for (const TreeNode& node : nodes_) area_ += half_area(box_around(node));
  built_area_ = area_;
}

BoxTree::ChildSlot& BoxTree::slot_of(std::int32_t child) {
  if (child >= 0) return slot_of_node_[static_cast<std::uint32_t>(child)];
  return slot_of_box_[index_of_leaf_[static_cast<std::uint32_t>(~child)]];
}

void BoxTree::find_slots(std::size_t count) {
  slot_of_node_.resize(nodes_.size());
  slot_of_box_.resize(count);
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    for (std::uint32_t i = 0; i < 8; ++i) {
      const std::int32_t child = nodes_[node].child[i];
      if (child != kNoChild) slot_of(child) = {node, i};
    }
  }
}

void BoxTree::move(const BoxReference& box) {
  ChildSlot slot = slot_of_box_[box.index];
  const float* low = box.low;
  const float* high = box.high;
  SplitNode around{};
  for (;;) {
    TreeNode& node = nodes_[slot.node];
    area_ -= half_area(box_around(node));
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][slot.child] = low[axis];
      node.high[axis][slot.child] = high[axis];
    }
    around = box_around(node);
    area_ += half_area(around);
    if (slot.node == 0) break;
    low = around.low;
    high = around.high;
    slot = slot_of_node_[slot.node];
  }
  sphere_ = sphere_of(around);
}

}  // namespace glidar::rays
