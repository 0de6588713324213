// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/triangle_blocks.hpp>

#include <cstdint>
#include <limits>

namespace glidar::rays {

/// A missing child of a node.
inline constexpr std::int32_t kNoChild = std::numeric_limits<std::int32_t>::min();

/// A node with up to eight children and their boxes. Boxes contain the triangles; the rays' padding
/// accounts for rounding.
struct alignas(64) TreeNode {
  float low[3][8];
  float high[3][8];
  std::int32_t child[8];  ///< a node's index; ~index of a cluster; kNoChild, with an empty box
};

/// The maximum number of nodes from the root to a leaf.
inline constexpr unsigned kMaxTreeDepth = 72;

/// The kernels' view of a tree over a mesh's triangles. Node 0 is the root.
struct TreeView {
  const TreeNode* nodes;
  const TriangleCluster* clusters;
  const TriangleBlock* blocks;
};

}  // namespace glidar::rays
