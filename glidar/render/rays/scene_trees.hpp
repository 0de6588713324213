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

/// Instances with similar reaches, see SceneTrees::reach_m(), and the tree over their boxes.
struct InstanceGroup {
  std::vector<std::uint32_t> instances;  ///< at least one
  BoxTree boxes;                         ///< unless the scene has a single instance
  double reach_m = 0.0;                  ///< the maximum of these and of the groups before

  /// Without clusters and blocks.
  [[nodiscard]] TreeView tree() const { return {boxes.nodes().data(), nullptr, nullptr}; }
};

/// The trees of a scene: one over the triangles of each mesh, in the mesh's frame, and above them
/// one over the boxes of each group of instances. The latter have their own frame, in metres: its
/// origin is where the sensor was when they were built, and its axes are those of the largest
/// instance. Boxes of objects that are aligned with it therefore stay small.
class SceneTrees {
 public:
  /// The resolver's scene must outlive the trees.
  SceneTrees(const Resolver& resolver, ThreadPool& thread_pool);

  /// Sets the poses of the next cast; the resolver has them too. The trees over the instances are
  /// refitted when few moved, and rebuilt when many moved or the sensor moved far; a cast with
  /// targets needs none of them, and leaves them as they are.
  void place(const CastRequest& request, const Resolver& resolver, ThreadPool& thread_pool);

  [[nodiscard]] const MeshTree& of_mesh(std::uint32_t mesh) const { return mesh_trees_[mesh]; }
  [[nodiscard]] const MeshTree& of_instance(std::uint32_t instance) const {
    return mesh_trees_[scene_.instances[instance].mesh];
  }

  /// From an instance's origin to its farthest vertex, object units.
  [[nodiscard]] double reach(std::uint32_t instance) const {
    return mesh_reach_[scene_.instances[instance].mesh];
  }

  /// Enabled instances with triangles. Of unmasked instances of one mesh at one pose it
  /// has only the one with the lowest index, which the hit rule reports.
  [[nodiscard]] const std::vector<std::uint32_t>& instances() const { return instances_; }

  /// instances() by increasing reach: few groups, mostly one.
  [[nodiscard]] const std::vector<InstanceGroup>& groups() const { return groups_; }
  [[nodiscard]] const Eigen::Matrix3d& tree_from_sensor() const { return tree_from_sensor_; }
  [[nodiscard]] const Eigen::Vector3d& sensor_in_tree() const { return sensor_in_tree_; }

  /// From an instance's origin to its farthest vertex and to the sensor, metres: its coordinates
  /// are rounded by 2^-53 of it.
  [[nodiscard]] double reach_m(std::uint32_t instance) const { return reach_m_[instance]; }
  /// The maximum over instances().
  [[nodiscard]] double max_reach_m() const { return max_reach_m_; }

 private:
  void find_reaches(const Resolver& resolver);
  void find_group_reaches();
  /// Refits the trees to the instances that moved; false: they must be rebuilt.
  [[nodiscard]] bool refit(const CastRequest& request);
  [[nodiscard]] bool has_same_instances(const CastRequest& request) const;
  [[nodiscard]] bool is_sensor_near(const CastRequest& request) const;
  void store_poses(const CastRequest& request, const Resolver& resolver);
  void remove_copies(const Resolver& resolver);
  void group_instances();
  void build_boxes(ThreadPool& thread_pool, InstanceGroup& group) const;
  [[nodiscard]] BoxReference reference_of(std::uint32_t instance) const;

  const Scene& scene_;
  std::vector<MeshTree> mesh_trees_;  ///< per mesh
  std::vector<double> mesh_reach_;    ///< per mesh: to its farthest vertex, object units
  std::vector<std::uint32_t> instances_;
  std::vector<double> reach_m_;  ///< per instance
  double max_reach_m_ = 0.0;

  std::vector<Pose> poses_;            ///< per instance, as the trees have them
  std::vector<std::uint8_t> enabled_;  ///< per instance
  std::vector<std::uint8_t> copies_;   ///< per instance: another one is at the same place
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();  ///< of the trees' frame, in the world
  Eigen::Matrix3d tree_from_world_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d tree_from_sensor_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d sensor_in_tree_ = Eigen::Vector3d::Zero();
  std::vector<InstanceGroup> groups_;
  std::vector<std::uint32_t> group_of_;  ///< per instance of instances_
  std::vector<std::uint32_t> moved_;     ///< since the last cast
};

}  // namespace glidar::rays
