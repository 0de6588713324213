// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>

#include <cstdint>
#include <memory>
#include <span>

namespace glidar::rays {

/// The box of a triangle and its index.
struct alignas(16) BoxReference {
  float low[3];
  std::uint32_t index;
  float high[3];
  std::uint32_t unused;
};

/// A node of a binary tree over boxes: a leaf holds references [first, first + count).
struct alignas(16) SplitNode {
  float low[3];
  std::uint32_t first;  ///< leaf: its first reference; otherwise index of its first child, which
                        ///< the second one follows
  float high[3];
  std::uint32_t count;  ///< 0: not a leaf
};

/// Half the surface of a node's box.
inline double half_area(const SplitNode& node) {
  const double x = double{node.high[0]} - node.low[0];
  const double y = double{node.high[1]} - node.low[1];
  const double z = double{node.high[2]} - node.low[2];
  return x * y + y * z + z * x;
}

struct SplitOptions {
  std::uint32_t leaf_size = 8;  ///< maximum
  std::uint32_t bins = 16;      ///< per axis, up to 16
  unsigned max_depth = 70;      ///< maximum, of leaves
};

/// The root is the first node.
struct SplitTree {
  std::unique_ptr<SplitNode[]> nodes;
  std::uint32_t count = 0;  ///< of nodes; 0 for no references

  [[nodiscard]] std::span<const SplitNode> view() const { return {nodes.get(), count}; }
};

/// Sorts the references into leaves by the surface area heuristic, for many references with bins
/// (I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007). The tree does
/// not depend on the number of threads, but the order of its nodes in memory does.
SplitTree build_split_tree(std::span<BoxReference> references, const SplitOptions& options,
                           ThreadPool& thread_pool);

}  // namespace glidar::rays
