// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/scene_trees.hpp>

#include <glidar/render/common/rounding.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace glidar::rays {
namespace {

/// Bounds rounding errors in double relative to coordinates: some 256 roundings.
constexpr double kMargin = 0x1p-44;
/// The tree is rebuilt when the sensor moves by this fraction of its size: then boxes near the
/// sensor, which single precision rounds by 2^-24 of their distance from the origin, stay small.
constexpr double kMoved = 0x1p-8;
/// It is rebuilt when more than 1 / kMovedDivisor of the instances moved in one step.
constexpr std::size_t kMovedDivisor = 8;
/// The maximum ratio of reaches in a group: rays are padded by some 2^-22 of their distance to the
/// boxes of a group and of its size, which is then less than the smallest reach.
constexpr double kMaxReachRatio = 0x1p20;

const Pose& pose_of(const Scene& scene, const CastRequest& request, std::size_t instance) {
  return request.world_from_instance.empty() ? scene.instances[instance].world_from_object
                                             : request.world_from_instance[instance];
}

}  // namespace

SceneTrees::SceneTrees(const Resolver& resolver, ThreadPool& thread_pool)
    : scene_(resolver.scene()), reach_m_(scene_.instances.size(), 0.0) {
  for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
    const Mesh& mesh = scene_.meshes[i];
    const MeshTriangles triangles{
        .positions = mesh.positions_m, .triangles = mesh.triangles, .chosen = resolver.distinct(i)};
    mesh_trees_.push_back(build_mesh_tree(triangles, {}, thread_pool));
    const Eigen::AlignedBox3d box = box_of(mesh_trees_.back());
    mesh_reach_.push_back(
        box.isEmpty() ? 0.0 : box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm());
  }
}

void SceneTrees::place(const CastRequest& request, const Resolver& resolver,
                       ThreadPool& thread_pool) {
  if (!request.targets.empty()) return find_reaches(resolver);
  if (refit(request)) {
    find_reaches(resolver);
  } else {
    store_poses(request, resolver);
    origin_m_ = request.world_from_sensor.translation();
    find_reaches(resolver);
    group_instances();
    if (instances_.size() > 1) {
      for (InstanceGroup& group : groups_) build_boxes(thread_pool, group);
    }
  }
  find_group_reaches();
  tree_from_sensor_ = tree_from_world_ * request.world_from_sensor.linear();
  sensor_in_tree_ = tree_from_world_ * (request.world_from_sensor.translation() - origin_m_);
}

void SceneTrees::find_reaches(const Resolver& resolver) {
  for (std::uint32_t i = 0; i < reach_m_.size(); ++i) {
    const InstanceView& view = resolver.view(i);
    reach_m_[i] =
        view.scale * (mesh_reach_[scene_.instances[i].mesh] + view.sensor_in_object.norm());
  }
}

void SceneTrees::find_group_reaches() {
  max_reach_m_ = 0.0;
  for (InstanceGroup& group : groups_) {
    for (const std::uint32_t i : group.instances) {
      max_reach_m_ = std::max(max_reach_m_, reach_m_[i]);
    }
    group.reach_m = max_reach_m_;
  }
}

bool SceneTrees::refit(const CastRequest& request) {
  if (!has_same_instances(request) || !is_sensor_near(request)) return false;
  moved_.clear();
  for (std::uint32_t i = 0; i < poses_.size(); ++i) {
    if (poses_[i].matrix() != pose_of(scene_, request, i).matrix()) moved_.push_back(i);
  }
  if (kMovedDivisor * moved_.size() > instances_.size()) return false;
  // a copy appears where the instance that hid it moved, and the other way round
  if (std::any_of(moved_.begin(), moved_.end(), [&](std::uint32_t i) { return copies_[i] != 0; }))
    return false;
  for (const std::uint32_t i : moved_) {
    poses_[i] = pose_of(scene_, request, i);
    if (enabled_[i] == 0 || of_instance(i).nodes.empty()) continue;
    groups_[group_of_[i]].boxes.move(reference_of(i));
  }
  return moved_.empty() ||
         std::none_of(groups_.begin(), groups_.end(),
                      [](const InstanceGroup& group) { return group.boxes.needs_rebuild(); });
}

bool SceneTrees::has_same_instances(const CastRequest& request) const {
  if (poses_.size() != scene_.instances.size()) return false;
  for (std::size_t i = 0; i < enabled_.size(); ++i) {
    if ((enabled_[i] != 0) != is_enabled(request, i)) return false;
  }
  return true;
}

bool SceneTrees::is_sensor_near(const CastRequest& request) const {
  const double moved_m = (request.world_from_sensor.translation() - origin_m_).norm();
  return std::all_of(groups_.begin(), groups_.end(), [&](const InstanceGroup& group) {
    return group.instances.size() < 2 || moved_m <= kMoved * group.boxes.sphere().radius;
  });
}

void SceneTrees::store_poses(const CastRequest& request, const Resolver& resolver) {
  poses_.resize(scene_.instances.size());
  enabled_.resize(scene_.instances.size());
  instances_.clear();
  for (std::uint32_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = pose_of(scene_, request, i);
    enabled_[i] = static_cast<std::uint8_t>(is_enabled(request, i));
    if (enabled_[i] != 0 && !of_instance(i).nodes.empty()) instances_.push_back(i);
  }
  remove_copies(resolver);
  double largest_m = -1.0;
  for (const std::uint32_t i : instances_) {
    const double size_m = scene_.instances[i].scale * of_instance(i).sphere.radius;
    if (!(size_m > largest_m)) continue;
    largest_m = size_m;
    tree_from_world_ = poses_[i].linear().transpose();
  }
}

/// Removes instances of one mesh at the pose of another: their hits tie exactly, and the hit rule
/// reports the instance with the lowest index. Masked ones stay, because their hits may differ.
void SceneTrees::remove_copies(const Resolver& resolver) {
  copies_.assign(poses_.size(), 0);
  if (instances_.size() < 2) return;
  const auto order = [&](std::uint32_t a, std::uint32_t b) {
    const Instance& one = scene_.instances[a];
    const Instance& other = scene_.instances[b];
    if (one.mesh != other.mesh) return one.mesh < other.mesh ? -1 : 1;
    if (one.scale != other.scale) return one.scale < other.scale ? -1 : 1;
    return std::memcmp(poses_[a].data(), poses_[b].data(), sizeof(double) * 16);
  };
  std::vector<std::uint32_t> sorted = instances_;
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int found = order(a, b);
    return found != 0 ? found < 0 : a < b;
  });
  std::vector<std::uint8_t> is_copy(poses_.size(), 0);
  for (std::size_t k = 1, first = 0; k < sorted.size(); ++k) {
    if (order(sorted[first], sorted[k]) != 0) first = k;
    if (first == k || resolver.is_masked(sorted[first]) || resolver.is_masked(sorted[k])) continue;
    is_copy[sorted[k]] = 1;
    copies_[sorted[k]] = copies_[sorted[first]] = 1;
  }
  std::erase_if(instances_, [&](std::uint32_t i) { return is_copy[i] != 0; });
}

BoxReference SceneTrees::reference_of(std::uint32_t instance) const {
  const double scale = scene_.instances[instance].scale;
  const Eigen::Vector3d& mesh_origin = scene_.meshes[scene_.instances[instance].mesh].origin_m;
  const Eigen::AlignedBox3d box = box_of(of_instance(instance));
  const Eigen::Matrix3d rotation = tree_from_world_ * poses_[instance].linear();
  const Eigen::Vector3d shift = poses_[instance].translation() - origin_m_;
  const Eigen::Vector3d in_object = scale * (mesh_origin + box.center());
  const Eigen::Vector3d middle = tree_from_world_ * shift + rotation * in_object;
  const double size = poses_[instance].translation().norm() + origin_m_.norm() +
                      scale * (mesh_origin.norm() + mesh_reach_[scene_.instances[instance].mesh]);
  const Eigen::Vector3d half =
      (rotation.cwiseAbs() * (0.5 * scale * box.sizes())).array() + kMargin * size;
  BoxReference reference{};
  for (int axis = 0; axis < 3; ++axis) {
    reference.low[axis] = next_below(middle[axis] - half[axis]);
    reference.high[axis] = next_above(middle[axis] + half[axis]);
  }
  reference.index = instance;
  return reference;
}

/// Each group starts at the smallest reach that is left.
void SceneTrees::group_instances() {
  const auto is_smaller = [&](std::uint32_t a, std::uint32_t b) {
    return reach_m_[a] < reach_m_[b];
  };
  groups_.clear();
  group_of_.resize(reach_m_.size());
  for (std::vector<std::uint32_t> left = instances_; !left.empty();) {
    const double smallest_m = reach_m_[*std::min_element(left.begin(), left.end(), is_smaller)];
    const auto end = std::stable_partition(left.begin(), left.end(), [&](std::uint32_t i) {
      return !(reach_m_[i] > kMaxReachRatio * smallest_m);
    });
    for (auto i = left.begin(); i != end; ++i) {
      group_of_[*i] = static_cast<std::uint32_t>(groups_.size());
    }
    groups_.push_back({.instances = {left.begin(), end}, .boxes = {}});
    left.erase(left.begin(), end);
  }
}

void SceneTrees::build_boxes(ThreadPool& thread_pool, InstanceGroup& group) const {
  constexpr std::size_t kInstanceGrain = 512;
  std::vector<BoxReference> references(group.instances.size());
  thread_pool.parallel_for(references.size(), kInstanceGrain,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t k = begin; k < end; ++k)
                               references[k] = reference_of(group.instances[k]);
                           });
  group.boxes.build(references, scene_.instances.size(), thread_pool);
}

}  // namespace glidar::rays
