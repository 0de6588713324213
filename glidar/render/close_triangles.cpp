// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/close_triangles.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/depth_range.hpp>
#include <glidar/render/rays/exact_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

using rays::MeshTree;
using rays::TreeNode;

constexpr double kMaxGapPart = 0x1p-10;     // of the mesh's reach: gaps up to it are found
constexpr double kTouchFraction = 0x1p-20;  // of it: smaller overlaps count as touching
constexpr double kMinParallelCosine = 0.9;  // of normals: other planes meet in a line

using Corners = std::array<Eigen::Vector3d, 3>;

Corners corners_at(const MeshTree& tree, std::uint32_t slot) {
  const HitTriangle t = triangle_at(tree.blocks.data(), slot);
  const auto corner = [](const std::array<float, 3>& p) -> Eigen::Vector3d {
    return {double{p[0]}, double{p[1]}, double{p[2]}};
  };
  return {corner(t.a), corner(t.b), corner(t.c)};
}

/// Unit normal; NaN for a triangle without area.
Eigen::Vector3d normal_of(const Corners& corners) {
  const Eigen::Vector3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  return cross / cross.norm();
}

/// A triangle with its normal and the outward normals of its edges.
struct ComparedTriangle {
  Corners corners;
  Eigen::Vector3d normal;
  std::array<Eigen::Vector3d, 3> outward;  ///< unit vectors in the plane, across the edges

  ComparedTriangle(const Corners& at, const Eigen::Vector3d& seen_along)
      : corners(at), normal(seen_along) {
    for (std::size_t k = 0; k < 3; ++k) {
      outward[k] = normal.cross(at[(k + 1) % 3] - at[k]).normalized();
      if (outward[k].dot(at[(k + 2) % 3] - at[k]) > 0.0) outward[k] = -outward[k];
    }
  }

  /// True when a line along an edge separates both triangles, except for an overlap of up to
  /// `touch`.
  [[nodiscard]] bool is_separated_from(const Corners& other, double touch) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge = outward[k].dot(corners[k]) - touch;
      if (outward[k].dot(other[0]) >= edge && outward[k].dot(other[1]) >= edge &&
          outward[k].dot(other[2]) >= edge) {
        return true;
      }
    }
    return false;
  }
};

/// Two triangles of which one covers the other.
struct ClosePair {
  std::uint32_t first;  ///< index in the mesh
  std::uint32_t second;
  float gap;
};

/// Searches the tree of one mesh.
class GapSearch {
 public:
  GapSearch(const MeshTree& tree, double reach)
      : tree_(tree), touch_(kTouchFraction * reach), max_gap_(kMaxGapPart * reach) {}

  /// Adds the pairs of a triangle with triangles of higher slots.
  void add_pairs(std::uint32_t slot, std::vector<ClosePair>& pairs) const {
    const Corners corners = corners_at(tree_, slot);
    const ComparedTriangle triangle(corners, normal_of(corners));
    if (triangle.normal.hasNaN()) return;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& corner : corners) box.extend(corner);
    box.min().array() -= max_gap_;
    box.max().array() += max_gap_;
    visit(0, {triangle, slot, box, pairs});
  }

  /// As add_pairs(), for all triangles of a cluster.
  void add_pairs_of(const TriangleCluster& cluster, std::vector<ClosePair>& pairs) const {
    const std::uint32_t first = cluster.first_block * kBlockSize;
    for (std::uint32_t k = 0; k < cluster.count; ++k) add_pairs(first + k, pairs);
  }

 private:
  struct Query {
    const ComparedTriangle& triangle;
    std::uint32_t slot;
    const Eigen::AlignedBox3d& box;
    std::vector<ClosePair>& pairs;
  };

  void visit(std::uint32_t index, const Query& query) const {
    const TreeNode& node = tree_.nodes[index];
    for (unsigned i = 0; i < 8; ++i) {
      const std::int32_t child = node.child[i];
      if (child == rays::kNoChild || !meets(node, i, query.box)) continue;
      if (child >= 0) {
        visit(static_cast<std::uint32_t>(child), query);
      } else {
        compare(tree_.clusters[static_cast<std::uint32_t>(~child)], query);
      }
    }
  }

  static bool meets(const TreeNode& node, unsigned child, const Eigen::AlignedBox3d& box) {
    for (int axis = 0; axis < 3; ++axis) {
      if (double{node.low[axis][child]} > box.max()[axis]) return false;
      if (double{node.high[axis][child]} < box.min()[axis]) return false;
    }
    return true;
  }

  void compare(const TriangleCluster& cluster, const Query& query) const {
    const std::uint32_t first = cluster.first_block * kBlockSize;
    for (std::uint32_t slot = std::max(first, query.slot + 1); slot < first + cluster.count;
         ++slot) {
      const double gap = gap_between(query.triangle, corners_at(tree_, slot));
      // Copies count as one triangle, whatever their winding.
      if (gap > max_gap_ || rays::have_same_corners(tree_.blocks.data(), query.slot, slot))
        continue;
      query.pairs.push_back({primitive(query.slot), primitive(slot), static_cast<float>(gap)});
    }
  }

  /// Distance of `other` from the triangle's plane where one covers the other; otherwise infinite.
  [[nodiscard]] double gap_between(const ComparedTriangle& triangle, const Corners& other) const {
    const double plane = triangle.normal.dot(triangle.corners[0]);
    const double a = triangle.normal.dot(other[0]) - plane;
    const double b = triangle.normal.dot(other[1]) - plane;
    const double c = triangle.normal.dot(other[2]) - plane;
    const double gap = std::max({std::min({a, b, c}), -std::max({a, b, c}), 0.0});
    if (gap > max_gap_ || triangle.is_separated_from(other, touch_)) return kInfinity;
    const bool is_parallel = std::abs(normal_of(other).dot(triangle.normal)) > kMinParallelCosine;
    if (!is_parallel ||
        ComparedTriangle(other, triangle.normal).is_separated_from(triangle.corners, touch_)) {
      return kInfinity;
    }
    return gap;
  }

  [[nodiscard]] std::uint32_t primitive(std::uint32_t slot) const {
    return tree_.blocks[slot / kBlockSize].primitive[slot % kBlockSize];
  }

  const MeshTree& tree_;
  double touch_;
  double max_gap_;
};

std::vector<ClosePair> find_pairs(const MeshTree& tree, double reach, ThreadPool& thread_pool) {
  constexpr std::size_t kClustersPerTask = 256;
  const GapSearch search(tree, reach);
  const std::size_t tasks = (tree.clusters.size() + kClustersPerTask - 1) / kClustersPerTask;
  std::vector<std::vector<ClosePair>> found(tasks);
  thread_pool.parallel_for(tasks, 1, [&](std::size_t begin, std::size_t end) {
    const std::size_t last = std::min(end * kClustersPerTask, tree.clusters.size());
    for (std::size_t i = begin * kClustersPerTask; i < last; ++i) {
      search.add_pairs_of(tree.clusters[i], found[begin]);
    }
  });
  std::vector<ClosePair> pairs;
  for (const std::vector<ClosePair>& some : found) {
    pairs.insert(pairs.end(), some.begin(), some.end());
  }
  return pairs;
}

}  // namespace

CloseTriangles::CloseTriangles(const Resolver& resolver, const rays::SceneTrees& trees,
                               std::span<const Eigen::AlignedBox3d> boxes, ThreadPool& thread_pool)
    : resolver_(resolver), trees_(trees), boxes_(boxes) {
  const Scene& scene = resolver.scene();
  gaps_.resize(scene.meshes.size());
  bits_.resize(scene.meshes.size());
  std::vector<bool> is_done(scene.meshes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t mesh = scene.instances[i].mesh;
    if (is_done[mesh] || trees.of_mesh(mesh).nodes.empty()) continue;
    is_done[mesh] = true;
    for (const ClosePair& pair : find_pairs(trees.of_mesh(mesh), trees.reach(i), thread_pool)) {
      gaps_[mesh].push_back({pair.first, pair.gap});
      gaps_[mesh].push_back({pair.second, pair.gap});
    }
  }
}

void CloseTriangles::set_bits(std::uint32_t mesh) {
  std::vector<std::uint64_t>& bits = bits_[mesh];
  std::fill(bits.begin(), bits.end(), 0);
  for (const Gap& gap : gaps_[mesh]) {
    if (double{gap.size} > limits_[mesh]) continue;
    bits.resize((resolver_.scene().meshes[mesh].triangles.size() + 63) / 64);
    bits[gap.primitive / 64] |= std::uint64_t{1} << gap.primitive % 64;
  }
}

void CloseTriangles::prepare(const CastRequest& request, double band_px) {
  constexpr double kSingleRoundingPart = 0x1p-20;  // of depths and sizes: 16 roundings
  const PinholeIntrinsics& pinhole = *request.beams.pinhole;
  const double pixel = 1.0 / std::min(std::abs(pinhole.fx), std::abs(pinhole.fy));
  const std::vector<Instance>& instances = resolver_.scene().instances;
  closeness_.assign(instances.size(), {nullptr, false});
  limits_.assign(gaps_.size(), -1.0);
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!is_enabled(request, i)) continue;
    const InstanceView& view = resolver_.view(i);
    double nearest_m = kInfinity;
    double farthest_m = 0.0;
    extend_depths(view, boxes_[instances[i].mesh], nearest_m, farthest_m);
    const double reach = trees_.reach(i);
    const double far = farthest_m / view.scale;
    const double limit = 2.0 * band_px * pixel * far + kSingleRoundingPart * (far + reach);
    closeness_[i].has_all = limit > kMaxGapPart * reach;
    double& of_mesh = limits_[instances[i].mesh];
    if (!closeness_[i].has_all) of_mesh = std::max(of_mesh, limit);
  }
  for (std::uint32_t mesh = 0; mesh < gaps_.size(); ++mesh) set_bits(mesh);
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const std::vector<std::uint64_t>& bits = bits_[instances[i].mesh];
    if (!closeness_[i].has_all && !bits.empty()) closeness_[i].bits = bits.data();
  }
}

}  // namespace glidar
