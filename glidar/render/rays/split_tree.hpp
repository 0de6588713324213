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
  std::uint32_t first;  ///< leaf: its first reference; otherwise index of the second child, the
                        ///< first one follows the node
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

/// Sorts the references into leaves by binned surface area heuristic (I. Wald, "On fast
/// Construction of SAH-based Bounding Volume Hierarchies", 2007). Returns the nodes, the root
/// first; nullptr for no references. The result does not depend on the number of threads.
std::unique_ptr<SplitNode[]> build_split_tree(std::span<BoxReference> references,
                                              const SplitOptions& options, ThreadPool& thread_pool);

}  // namespace glidar::rays
