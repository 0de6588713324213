// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolve.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace glidar {

/// Bounding boxes of the triangles of a mesh, and eight boxes to a box of the next level. For the
/// few beams that need a test of every triangle they may meet. All coordinates are in object units
/// relative to the mesh's origin.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);

  /// Of all triangles; empty when there are none.
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }
  /// From the mesh's origin to its farthest vertex, or a little more.
  [[nodiscard]] double reach() const { return reach_; }

  /// Calls visit(triangle) for every triangle whose box, grown by `margin`, meets the ray between
  /// its origin and the distance `most`. visit may lower `most`.
  template <class Visit>
  void visit_along(const ObjectRay& ray, double margin, const double& most,
                   const Visit& visit) const {
    visit_all([&](const Box& box) { return meets(ray, margin, most, box); }, visit);
  }

  /// Calls visit(triangle) for every triangle whose box, grown by `margin`, holds the point.
  template <class Visit>
  void visit_at(const Eigen::Vector3d& point, double margin, const Visit& visit) const {
    visit_all([&](const Box& box) { return holds(box, margin, point); }, visit);
  }

  /// True when the box of some triangle, grown by `margin`, intersects this one.
  [[nodiscard]] bool has_any_near(const Eigen::AlignedBox3d& box, double margin) const {
    const Eigen::Vector3d room = Eigen::Vector3d::Constant(margin);
    return !levels_.empty() &&
           has_near(levels_.size() - 1, 0, {box.min() - room, box.max() + room});
  }

 private:
  struct Box {
    Eigen::Vector3f min;
    Eigen::Vector3f max;
  };

  static constexpr std::size_t kFan = 8;

  static bool holds(const Box& box, double margin, const Eigen::Vector3d& point) {
    return ((point - box.min.cast<double>()).array() >= -margin).all() &&
           ((point - box.max.cast<double>()).array() <= margin).all();
  }
  static bool meets(const ObjectRay& ray, double margin, double most, const Box& box);

  template <class Test, class Visit>
  void visit_all(const Test& test, const Visit& visit) const {
    if (!levels_.empty()) visit_box(levels_.size() - 1, 0, test, visit);
  }

  template <class Test, class Visit>
  void visit_box(std::size_t level, std::size_t index, const Test& test, const Visit& visit) const {
    if (!test(levels_[level][index])) return;
    if (level == 0) return visit(triangles_[index]);
    const std::size_t end = std::min(levels_[level - 1].size(), (index + 1) * kFan);
    for (std::size_t i = index * kFan; i < end; ++i) visit_box(level - 1, i, test, visit);
  }

  [[nodiscard]] bool has_near(std::size_t level, std::size_t index,
                              const Eigen::AlignedBox3d& box) const {
    const Box& node = levels_[level][index];
    if ((node.min.cast<double>().array() > box.max().array()).any() ||
        (node.max.cast<double>().array() < box.min().array()).any()) {
      return false;
    }
    if (level == 0) return true;
    const std::size_t end = std::min(levels_[level - 1].size(), (index + 1) * kFan);
    for (std::size_t i = index * kFan; i < end; ++i) {
      if (has_near(level - 1, i, box)) return true;
    }
    return false;
  }

  std::vector<std::uint32_t> triangles_;  ///< along a curve through space
  std::vector<std::vector<Box>> levels_;  ///< the first of triangles; the last has one box
  Eigen::AlignedBox3d box_;
  double reach_ = 0.0;
};

/// One tree per mesh, built when it is first needed, by whichever thread that is.
class TriangleTrees {
 public:
  /// The scene must outlive the trees.
  explicit TriangleTrees(const Scene& scene)
      : scene_(scene), trees_(std::make_unique<Lazy[]>(scene.meshes.size())) {}

  [[nodiscard]] const TriangleTree& of_mesh(std::uint32_t mesh) const {
    Lazy& lazy = trees_[mesh];
    std::call_once(lazy.once,
                   [&] { lazy.tree = std::make_unique<TriangleTree>(scene_.meshes[mesh]); });
    return *lazy.tree;
  }

 private:
  struct Lazy {
    std::once_flag once;
    std::unique_ptr<TriangleTree> tree;
  };

  const Scene& scene_;
  std::unique_ptr<Lazy[]> trees_;
};

}  // namespace glidar
