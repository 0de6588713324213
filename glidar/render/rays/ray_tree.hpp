// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/triangle_blocks.hpp>

#include <cstdint>
#include <limits>

namespace glidar::rays {

/// A child of a node that is not there.
inline constexpr std::int32_t kNoChild = std::numeric_limits<std::int32_t>::min();

/// A node with up to eight children and their boxes. Boxes hold the triangles; the rays' padding
/// makes up for rounding.
struct alignas(64) TreeNode {
  float low[3][8];
  float high[3][8];
  std::int32_t child[8];  ///< a node's index; ~index of a cluster; kNoChild, with an empty box
};

/// The largest number of nodes from the root to a leaf.
inline constexpr unsigned kMaxTreeDepth = 72;

/// What the kernels read of a tree over a mesh's triangles. Node 0 is the root.
struct TreeView {
  const TreeNode* nodes;
  const TriangleCluster* clusters;
  const TriangleBlock* blocks;
};

}  // namespace glidar::rays
