// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/mesh_tree.hpp>

#include <glidar/core/error.hpp>
#include <glidar/render/rays/split_tree.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>

namespace glidar::rays {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr std::uint32_t kMaxClusterSize = 64;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

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

std::vector<BoxReference> make_references(const MeshTriangles& mesh, Workers& workers) {
  std::vector<BoxReference> references(mesh.triangles.size());
  workers.for_ranges(references.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) references[i] = make_reference(mesh, i);
  });
  return references;
}

float area_of(const SplitNode& node) {
  const float x = node.high[0] - node.low[0];
  const float y = node.high[1] - node.low[1];
  const float z = node.high[2] - node.low[2];
  return x * y + y * z + z * x;
}

/// Turns the binary tree into one of eight children per node, and its leaves into clusters.
class Collapse {
 public:
  Collapse(const SplitNode* split, MeshTree& tree) : split_(split), tree_(tree) {}

  /// References of each cluster, in the order of clusters.
  struct Leaf {
    std::uint32_t first;
    std::uint32_t count;
  };
  std::vector<Leaf> leaves;

  void add_node(std::uint32_t root) {
    const auto index = static_cast<std::int32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const Children children = children_of(root);
    for (unsigned i = 0; i < 8; ++i) set_child(tree_.nodes[index], i, children);
    for (unsigned i = 0; i < children.count; ++i) {
      if (split_[children.at[i]].count != 0) continue;
      const auto child = static_cast<std::int32_t>(tree_.nodes.size());
      tree_.nodes[static_cast<std::size_t>(index)].child[i] = child;
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
      float area = -1.0F;
      for (unsigned i = 0; i < children.count; ++i) {
        const SplitNode& node = split_[children.at[i]];
        if (node.count != 0 || area_of(node) <= area) continue;
        largest = i;
        area = area_of(node);
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
      node.low[axis][i] = is_there ? child->low[axis] : kInfinity;
      node.high[axis][i] = is_there ? child->high[axis] : -kInfinity;
    }
    node.child[i] = kNoChild;
    if (!is_there || child->count == 0) return;
    node.child[i] = ~static_cast<std::int32_t>(leaves.size());
    leaves.push_back({child->first, child->count});
  }

  const SplitNode* split_;
  MeshTree& tree_;
};

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

/// What is copied into blocks.
struct Packing {
  const MeshTriangles& mesh;
  const std::vector<Collapse::Leaf>& leaves;
  const std::vector<BoxReference>& references;
};

void pack_leaf(const Packing& packing, std::size_t index, MeshTree& tree) {
  const Collapse::Leaf& leaf = packing.leaves[index];
  std::array<std::uint32_t, kMaxClusterSize> chosen{};
  for (std::uint32_t k = 0; k < leaf.count; ++k) {
    chosen[k] = packing.references[leaf.first + k].index;
  }
  pack_cluster(packing.mesh, std::span(chosen).first(leaf.count), tree.clusters[index],
               tree.blocks);
}

/// Copies the triangles of the leaves into blocks.
void pack(const Packing& packing, MeshTree& tree, Workers& workers) {
  tree.clusters.resize(packing.leaves.size());
  std::uint32_t blocks = 0;
  for (std::size_t i = 0; i < tree.clusters.size(); ++i) {
    tree.clusters[i].first_block = blocks;
    blocks += block_count(packing.leaves[i].count);
  }
  tree.blocks.resize(blocks);
  workers.for_ranges(tree.clusters.size(), kGrain / 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pack_leaf(packing, i, tree);
  });
}

}  // namespace

std::size_t MeshTree::bytes() const {
  return nodes.size() * sizeof(TreeNode) + clusters.size() * sizeof(TriangleCluster) +
         blocks.size() * sizeof(TriangleBlock);
}

MeshTree build_mesh_tree(const MeshTriangles& mesh, const TreeOptions& options, Workers& workers) {
  check_vertices(mesh);
  MeshTree tree;
  std::vector<BoxReference> references = make_references(mesh, workers);
  const SplitOptions split_options = {
      .leaf_size = std::clamp(options.cluster_size, 1U, kMaxClusterSize),
      .bins = std::clamp(options.bins, 2U, 16U),
      .max_depth = kMaxTreeDepth - 2};
  const auto split = build_split_tree(references, split_options, workers);
  if (split == nullptr) return tree;
  tree.sphere = sphere_of(split[0]);
  Collapse collapse(split.get(), tree);
  collapse.add_node(0);
  pack({mesh, collapse.leaves, references}, tree, workers);
  return tree;
}

}  // namespace glidar::rays
