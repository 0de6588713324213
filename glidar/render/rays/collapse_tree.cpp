// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/collapse_tree.hpp>

#include <glidar/math/constants.hpp>

#include <array>
#include <cmath>

namespace glidar::rays {
namespace {

class Collapse {
 public:
  Collapse(const SplitNode* split, std::vector<TreeNode>& nodes, std::vector<LeafRange>& leaves)
      : split_(split), nodes_(nodes), leaves_(leaves) {}

  void add_node(std::uint32_t root) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    const Children children = children_of(root);
    for (unsigned i = 0; i < 8; ++i) set_child(nodes_[index], i, children);
    for (unsigned i = 0; i < children.count; ++i) {
      if (split_[children.at[i]].count != 0) continue;
      const auto child = static_cast<std::int32_t>(nodes_.size());
      nodes_[static_cast<std::size_t>(index)].child[i] = child;
      add_node(children.at[i]);
    }
  }

 private:
  struct Children {
    std::array<std::uint32_t, 8> at{};
    unsigned count = 0;
  };

  /// The node's two children, of which the largest is replaced by its own until there are eight.
  [[nodiscard]] Children children_of(std::uint32_t root) const {
    Children children;
    children.at[0] = root;
    children.count = 1;
    while (children.count < 8) {
      unsigned largest = 8;
      double area = -1.0;
      for (unsigned i = 0; i < children.count; ++i) {
        const SplitNode& node = split_[children.at[i]];
        if (node.count != 0 || half_area(node) <= area) continue;
        largest = i;
        area = half_area(node);
      }
      if (largest == 8) break;
      const std::uint32_t opened = children.at[largest];
      children.at[largest] = opened + 1;
      children.at[children.count++] = split_[opened].first;
    }
    return children;
  }

  void set_child(TreeNode& node, unsigned i, const Children& children) {
    const bool is_there = i < children.count;
    const SplitNode* child = is_there ? &split_[children.at[i]] : nullptr;
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][i] = is_there ? child->low[axis] : kInfinityf;
      node.high[axis][i] = is_there ? child->high[axis] : -kInfinityf;
    }
    node.child[i] = kNoChild;
    if (!is_there || child->count == 0) return;
    node.child[i] = ~static_cast<std::int32_t>(leaves_.size());
    leaves_.push_back({child->first, child->count});
  }

  const SplitNode* split_;
  std::vector<TreeNode>& nodes_;
  std::vector<LeafRange>& leaves_;
};

}  // namespace

void collapse_tree(const SplitNode* split, std::vector<TreeNode>& nodes,
                   std::vector<LeafRange>& leaves) {
  nodes.clear();
  leaves.clear();
  Collapse(split, nodes, leaves).add_node(0);
}

MeshSphere sphere_of(const SplitNode& root) {
  MeshSphere sphere;
  double squared = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = root.low[axis];
    const double high = root.high[axis];
    sphere.centre[axis] = 0.5 * (low + high);
    squared += (high - low) * (high - low);
  }
  sphere.radius = 0.5 * std::sqrt(squared) * (1.0 + 1e-12);
  return sphere;
}

}  // namespace glidar::rays
