// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/render/rays/ray_packet.hpp>
#include <glidar/render/rays/ray_tree.hpp>

#include <Eigen/Geometry>
#include <vector>

namespace glidar::rays {

/// The largest coordinate of a vertex in a tree, 7.9e28: boxes are in single precision.
inline constexpr float kMaxTreeCoordinate = 0x1p96F;

/// A tree over the triangles of a mesh. Results do not depend on how it is built.
struct MeshTree {
  std::vector<TreeNode> nodes;
  std::vector<TriangleCluster> clusters;
  std::vector<TriangleBlock> blocks;
  MeshSphere sphere;

  [[nodiscard]] TreeView view() const { return {nodes.data(), clusters.data(), blocks.data()}; }
  /// Memory of its arrays, without reserved capacity.
  [[nodiscard]] std::size_t bytes() const;
};

/// The box of all triangles; empty when there are none.
Eigen::AlignedBox3d box_of(const MeshTree& tree);

/// True when the box of some triangle, grown by `margin`, intersects this one.
bool has_triangle_near(const MeshTree& tree, const Eigen::AlignedBox3d& box, double margin);

/// True when a point may be within a distance of some triangle: its box and its plane are.
bool may_touch_triangle(const MeshTree& tree, const Eigen::Vector3d& point, double distance);

struct TreeOptions {
  std::uint32_t cluster_size = 8;  ///< maximum triangles per leaf, 1 to 64
  std::uint32_t bins = 16;         ///< of the surface area heuristic per axis, 2 to 16
};

/// Builds the tree. Throws Error on a vertex beyond kMaxTreeCoordinate.
MeshTree build_mesh_tree(const MeshTriangles& mesh, const TreeOptions& options,
                         ThreadPool& thread_pool);

}  // namespace glidar::rays
