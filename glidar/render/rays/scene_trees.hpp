// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/box_tree.hpp>
#include <glidar/render/rays/mesh_tree.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/resolver.hpp>

#include <cstdint>
#include <vector>

namespace glidar::rays {

/// The trees of a scene: one over the triangles of each mesh, in the mesh's frame, and above them
/// one over the boxes of the instances. The latter has its own frame, in metres: its origin is
/// where the sensor was when it was built, and its axes are those of the largest instance. Boxes of
/// objects that are aligned with it therefore stay small.
class SceneTrees {
 public:
  /// The resolver's scene must outlive the trees.
  SceneTrees(const Resolver& resolver, ThreadPool& thread_pool);

  /// Sets the poses of the next cast; the resolver has them too. The tree over the instances is
  /// refitted when few moved, and rebuilt when many moved or the sensor moved far.
  void place(const CastRequest& request, const Resolver& resolver, ThreadPool& thread_pool);

  [[nodiscard]] const MeshTree& of_mesh(std::uint32_t mesh) const { return mesh_trees_[mesh]; }
  [[nodiscard]] const MeshTree& of_instance(std::uint32_t instance) const {
    return mesh_trees_[scene_.instances[instance].mesh];
  }

  /// From an instance's origin to its farthest vertex, object units.
  [[nodiscard]] double reach(std::uint32_t instance) const {
    return mesh_reach_[scene_.instances[instance].mesh];
  }

  /// Enabled instances with triangles.
  [[nodiscard]] const std::vector<std::uint32_t>& instances() const { return instances_; }

  /// The tree over instances(), if there are at least two; without clusters and blocks.
  [[nodiscard]] TreeView instance_tree() const {
    return {instance_nodes().data(), nullptr, nullptr};
  }
  [[nodiscard]] const std::vector<TreeNode>& instance_nodes() const { return boxes_.nodes(); }
  /// The instance in a leaf of that tree.
  [[nodiscard]] std::uint32_t instance_in(std::uint32_t leaf) const {
    return boxes_.index_in(leaf);
  }
  [[nodiscard]] const MeshSphere& instance_sphere() const { return boxes_.sphere(); }
  [[nodiscard]] const Eigen::Matrix3d& tree_from_sensor() const { return tree_from_sensor_; }
  [[nodiscard]] const Eigen::Vector3d& sensor_in_tree() const { return sensor_in_tree_; }

  /// From an instance's origin to its farthest vertex and to the sensor, metres: its coordinates
  /// are rounded by 2^-53 of it.
  [[nodiscard]] double reach_m(std::uint32_t instance) const { return reach_m_[instance]; }
  /// The maximum over instances().
  [[nodiscard]] double largest_reach_m() const { return largest_reach_m_; }

 private:
  void find_reaches(const Resolver& resolver);
  /// Refits the tree to the instances that moved; false: it must be rebuilt.
  [[nodiscard]] bool refit(const CastRequest& request);
  [[nodiscard]] bool has_same_instances(const CastRequest& request) const;
  [[nodiscard]] bool is_sensor_near(const CastRequest& request) const;
  void store_poses(const CastRequest& request);
  void build_instance_tree(ThreadPool& thread_pool);
  [[nodiscard]] BoxReference reference_of(std::uint32_t instance) const;

  const Scene& scene_;
  std::vector<MeshTree> mesh_trees_;  ///< per mesh
  std::vector<double> mesh_reach_;    ///< per mesh: to its farthest vertex, object units
  std::vector<std::uint32_t> instances_;
  std::vector<double> reach_m_;  ///< per instance
  double largest_reach_m_ = 0.0;

  std::vector<Pose> poses_;                             ///< per instance, as the tree has them
  std::vector<std::uint8_t> enabled_;                   ///< per instance
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();  ///< of the tree's frame, in the world
  Eigen::Matrix3d tree_from_world_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d tree_from_sensor_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d sensor_in_tree_ = Eigen::Vector3d::Zero();
  BoxTree boxes_;                     ///< of instances_, if there are at least two
  std::vector<std::uint32_t> moved_;  ///< since the last cast
};

}  // namespace glidar::rays
