// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/collapse_tree.hpp>

#include <glidar/math/constants.hpp>

#include <array>
#include <cmath>
#include <span>

namespace glidar::rays {
namespace {

constexpr unsigned kFan = 8;

/// Selects the nodes of the binary tree that are kept. Rays visit nodes in proportion to their
/// areas, so the sum of these is minimised by dynamic programming (H. Ylitie, T. Karras and S.
/// Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017).
class Selection {
 public:
  explicit Selection(std::span<const SplitNode> split) : split_(split), choices_(split.size()) {
    cost_of(0);
  }

  /// Calls visit(child) for the up to kFan children of a node that is kept.
  template <class Visit>
  void for_children(std::uint32_t node, const Visit& visit) const {
    if (split_[node].count != 0) return visit(node);  // the root is a leaf
    divide(node, choices_[node].of_kept, kFan, visit);
  }

 private:
  /// [i - 1]: the minimum cost of a subtree that becomes up to i children of a node.
  using Costs = std::array<double, kFan>;

  /// How the children of an inner node are shared between its two sides.
  struct Choice {
    std::uint8_t of_kept;  ///< first side's, when the node is kept and has kFan children
    /// [i - 2]: first side's, when the subtree becomes up to i children; 0: it becomes one.
    std::array<std::uint8_t, kFan - 1> of_opened;
  };

  Costs cost_of(std::uint32_t index) {
    const SplitNode& node = split_[index];
    Costs costs{};
    if (node.count != 0) return costs;  // leaves are always kept
    const Costs first = cost_of(node.first);
    const Costs second = cost_of(node.first + 1);
    Choice& choice = choices_[index];
    for (unsigned i = 2; i <= kFan; ++i) {
      double least = first[0] + second[i - 2];
      unsigned best = 1;
      for (unsigned k = 2; k < i; ++k) {
        const double cost = first[k - 1] + second[i - k - 1];
        best = cost < least ? k : best;
        least = cost < least ? cost : least;
      }
      costs[i - 1] = least;
      choice.of_opened[i - 2] = static_cast<std::uint8_t>(best);
    }
    choice.of_kept = choice.of_opened[kFan - 2];
    costs[0] = costs[kFan - 1] + half_area(node);
    for (unsigned i = 2; i <= kFan; ++i) {
      if (costs[i - 1] < costs[0]) continue;
      costs[i - 1] = costs[0];
      choice.of_opened[i - 2] = 0;
    }
    return costs;
  }

  template <class Visit>
  void divide(std::uint32_t node, unsigned first, unsigned count, const Visit& visit) const {
    open(split_[node].first, first, visit);
    open(split_[node].first + 1, count - first, visit);
  }

  template <class Visit>
  void open(std::uint32_t node, unsigned count, const Visit& visit) const {
    const bool is_child = split_[node].count != 0 || count == 1;
    const unsigned first = is_child ? 0 : choices_[node].of_opened[count - 2];
    if (first == 0) return visit(node);
    divide(node, first, count, visit);
  }

  std::span<const SplitNode> split_;
  std::vector<Choice> choices_;  ///< per node
};

class Collapse {
 public:
  Collapse(std::span<const SplitNode> split, std::vector<TreeNode>& nodes,
           std::vector<LeafRange>& leaves)
      : split_(split), selection_(split), nodes_(nodes), leaves_(leaves) {}

  void add_node(std::uint32_t root) {
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    std::array<std::uint32_t, kFan> children{};
    unsigned count = 0;
    selection_.for_children(root, [&](std::uint32_t child) { children[count++] = child; });
    for (unsigned i = 0; i < kFan; ++i) {
      set_child(nodes_.back(), i, i < count ? &split_[children[i]] : nullptr);
    }
    for (unsigned i = 0; i < count; ++i) {
      if (split_[children[i]].count != 0) continue;
      const auto child = static_cast<std::int32_t>(nodes_.size());
      nodes_[static_cast<std::size_t>(index)].child[i] = child;
      add_node(children[i]);
    }
  }

 private:
  void set_child(TreeNode& node, unsigned i, const SplitNode* child) {
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][i] = child != nullptr ? child->low[axis] : kInfinityf;
      node.high[axis][i] = child != nullptr ? child->high[axis] : -kInfinityf;
    }
    node.child[i] = kNoChild;
    if (child == nullptr || child->count == 0) return;
    node.child[i] = ~static_cast<std::int32_t>(leaves_.size());
    leaves_.push_back({child->first, child->count});
  }

  std::span<const SplitNode> split_;
  Selection selection_;
  std::vector<TreeNode>& nodes_;
  std::vector<LeafRange>& leaves_;
};

}  // namespace

void collapse_tree(std::span<const SplitNode> split, std::vector<TreeNode>& nodes,
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
