// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ray_tree.hpp>
#include <glidar/render/rays/split_tree.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar::rays {

/// References of a leaf: [first, first + count).
struct LeafRange {
  std::uint32_t first;
  std::uint32_t count;
};

/// Collapses a binary tree with at least a root into one of eight children per node. Nodes refer to
/// leaves[i] as ~i.
void collapse_tree(std::span<const SplitNode> split, std::vector<TreeNode>& nodes,
                   std::vector<LeafRange>& leaves);

/// A sphere around the box of a node.
MeshSphere sphere_of(const SplitNode& root);

}  // namespace glidar::rays
