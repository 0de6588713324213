// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/mesh_tree.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/rays/collapse_tree.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>

namespace glidar::rays {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr std::uint32_t kMaxClusterSize = 64;

void check_vertices(const MeshTriangles& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float size = mesh.positions[i].cwiseAbs().maxCoeff();
    if (size <= kMaxTreeCoordinate) continue;
    throw Error({"vertex " + std::to_string(i) + " of a mesh",
                 "a coordinate is " + number_text(static_cast<double>(size)),
                 "up to " + number_text(static_cast<double>(kMaxTreeCoordinate)),
                 "choose another unit, or another origin"});
  }
}

BoxReference make_reference(const MeshTriangles& mesh, std::size_t index) {
  const auto& [a, b, c] = mesh.triangles[index];
  BoxReference reference{};
  reference.index = static_cast<std::uint32_t>(index);
  for (int axis = 0; axis < 3; ++axis) {
    const float x = mesh.positions[a][axis];
    const float y = mesh.positions[b][axis];
    const float z = mesh.positions[c][axis];
    reference.low[axis] = std::min({x, y, z});
    reference.high[axis] = std::max({x, y, z});
  }
  return reference;
}

std::vector<BoxReference> make_references(const MeshTriangles& mesh, ThreadPool& thread_pool) {
  const bool has_all = mesh.chosen.empty();
  std::vector<BoxReference> references(has_all ? mesh.triangles.size() : mesh.chosen.size());
  thread_pool.parallel_for(references.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      references[i] = make_reference(mesh, has_all ? i : mesh.chosen[i]);
    }
  });
  return references;
}

/// Inputs for copying triangles into blocks.
struct Packing {
  const MeshTriangles& mesh;
  const std::vector<LeafRange>& leaves;
  const std::vector<BoxReference>& references;
};

void pack_leaf(const Packing& packing, std::size_t index, MeshTree& tree) {
  const LeafRange& leaf = packing.leaves[index];
  std::array<std::uint32_t, kMaxClusterSize> chosen{};
  for (std::uint32_t k = 0; k < leaf.count; ++k) {
    chosen[k] = packing.references[leaf.first + k].index;
  }
  pack_cluster(packing.mesh, std::span(chosen).first(leaf.count), tree.clusters[index],
               tree.blocks);
}

/// Copies the triangles of the leaves into blocks.
void pack(const Packing& packing, MeshTree& tree, ThreadPool& thread_pool) {
  tree.clusters.resize(packing.leaves.size());
  std::uint32_t blocks = 0;
  for (std::size_t i = 0; i < tree.clusters.size(); ++i) {
    tree.clusters[i].first_block = blocks;
    blocks += block_count(packing.leaves[i].count);
  }
  tree.blocks.resize(blocks);
  thread_pool.parallel_for(tree.clusters.size(), kGrain / 8,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t i = begin; i < end; ++i) pack_leaf(packing, i, tree);
                           });
}

Eigen::AlignedBox3d child_box(const TreeNode& node, unsigned child) {
  Eigen::AlignedBox3d box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = double{node.low[axis][child]};
    box.max()[axis] = double{node.high[axis][child]};
  }
  return box;
}

Eigen::AlignedBox3d triangle_box(const TriangleBlock& block, unsigned i) {
  Eigen::AlignedBox3d box;
  for (const auto& corner : block.corner) {
    box.extend(Eigen::Vector3d(double{corner[0][i]}, double{corner[1][i]}, double{corner[2][i]}));
  }
  return box;
}

/// Whether accepts(block, i) for a triangle whose box intersects this one.
template <class Accepts>
bool any_triangle_in(const MeshTree& tree, std::int32_t index, const Eigen::AlignedBox3d& box,
                     const Accepts& accepts) {
  if (index < 0) {
    const TriangleCluster& cluster = tree.clusters[static_cast<std::uint32_t>(~index)];
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const TriangleBlock& block = tree.blocks[cluster.first_block + i / kBlockSize];
      const unsigned place = i % kBlockSize;
      if (triangle_box(block, place).intersects(box) && accepts(block, place)) return true;
    }
    return false;
  }
  const TreeNode& node = tree.nodes[static_cast<std::size_t>(index)];
  for (unsigned i = 0; i < 8; ++i) {
    if (node.child[i] == kNoChild || !child_box(node, i).intersects(box)) continue;
    if (any_triangle_in(tree, node.child[i], box, accepts)) return true;
  }
  return false;
}

/// Whether the plane of a triangle passes a point within a distance. A triangle without area has
/// no plane, so that it passes everywhere.
bool has_plane_near(const TriangleBlock& block, unsigned i, const Eigen::Vector3d& point,
                    double distance) {
  std::array<Eigen::Vector3d, 3> from_point;
  for (unsigned k = 0; k < 3; ++k) {
    const auto& corner = block.corner[k];
    from_point[k] =
        Eigen::Vector3d(double{corner[0][i]}, double{corner[1][i]}, double{corner[2][i]}) - point;
  }
  const Eigen::Vector3d normal =
      (from_point[1] - from_point[0]).cross(from_point[2] - from_point[0]);
  const double volume = std::abs(normal.dot(from_point[0]));
  return !(volume > distance * normal.norm());
}

}  // namespace

Eigen::AlignedBox3d box_of(const MeshTree& tree) {
  Eigen::AlignedBox3d box;
  if (tree.nodes.empty()) return box;
  for (unsigned i = 0; i < 8; ++i) {
    if (tree.nodes[0].child[i] != kNoChild) box.extend(child_box(tree.nodes[0], i));
  }
  return box;
}

bool has_triangle_near(const MeshTree& tree, const Eigen::AlignedBox3d& box, double margin) {
  const Eigen::Vector3d growth = Eigen::Vector3d::Constant(margin);
  return !tree.nodes.empty() &&
         any_triangle_in(tree, 0, {box.min() - growth, box.max() + growth},
                         [](const TriangleBlock&, unsigned) { return true; });
}

bool may_touch_triangle(const MeshTree& tree, const Eigen::Vector3d& point, double distance) {
  const Eigen::Vector3d growth = Eigen::Vector3d::Constant(distance);
  return !tree.nodes.empty() && any_triangle_in(tree, 0, {point - growth, point + growth},
                                                [&](const TriangleBlock& block, unsigned i) {
                                                  return has_plane_near(block, i, point, distance);
                                                });
}

std::size_t MeshTree::bytes() const {
  return nodes.size() * sizeof(TreeNode) + clusters.size() * sizeof(TriangleCluster) +
         blocks.size() * sizeof(TriangleBlock);
}

MeshTree build_mesh_tree(const MeshTriangles& mesh, const TreeOptions& options,
                         ThreadPool& thread_pool) {
  check_vertices(mesh);
  MeshTree tree;
  std::vector<BoxReference> references = make_references(mesh, thread_pool);
  const SplitOptions split_options = {
      .leaf_size = std::clamp(options.cluster_size, 1U, kMaxClusterSize),
      .bins = std::clamp(options.bins, 2U, 16U),
      .max_depth = kMaxTreeDepth - 2};
  SplitTree split = build_split_tree(references, split_options, thread_pool);
  if (split.count == 0) return tree;
  tree.sphere = sphere_of(split.nodes[0]);
  std::vector<LeafRange> leaves;
  collapse_tree(split.view(), tree.nodes, leaves);
  split = {};
  pack({mesh, leaves, references}, tree, thread_pool);
  return tree;
}

}  // namespace glidar::rays
