// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/core/mesh.hpp>
#include <glidar/core/pose.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// A mesh in the world: p_world = world_from_object * (scale * p_object).
struct Instance {
  std::string name;
  std::uint32_t mesh = 0;  ///< index into Scene::meshes
  Pose world_from_object = Pose::Identity();
  double scale = 1.0;                    ///< > 0, uniform
  std::uint32_t id = 0;                  ///< the user's number, written to clouds
  std::uint32_t class_id = 0;            ///< index into Scene::class_names
  std::vector<std::uint32_t> materials;  ///< material slot -> index into Scene::materials
  /// Sensors by Frame::sensor_id, their position on the rig: these alone see it; empty: all do.
  std::vector<std::uint32_t> visible_to = {};
  std::vector<std::uint32_t> hidden_from = {};  ///< these do not see it, even if in visible_to
};

/// The origin of a mesh, as written to the sidecar.
struct MeshSource {
  std::string path;  ///< the file, or "builtin:NAME"
  std::string hash;  ///< hash of the file's content, hexadecimal; empty for built-in meshes
  std::vector<std::string> files = {};  ///< canonical paths of all files read, textures included
  double metres_per_unit = 1.0;         ///< applied unit of the file
  bool unit_known = false;              ///< true: the file or the user specified it; false: assumed
  std::string up = {};  ///< the axis of the file that became z; empty: axes unchanged
  /// The mesh is mesh `unstretched` (an index into Scene::meshes), scaled by this along x, y and z.
  Eigen::Vector3d stretch = Eigen::Vector3d::Ones();
  std::uint32_t unstretched = 0;  ///< only used where stretch is not 1, 1, 1
};

/// Limits of an instance's scale, and of the distance of its farthest vertex from its origin if it
/// has vertices: products of both are far from the limits of single precision.
inline constexpr double kMinScale = 1e-15;
inline constexpr double kMaxScale = 1e15;
inline constexpr double kMinReach_m = 1e-30;

/// The scene as plain arrays and indices.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<MeshSource> sources;  ///< one per mesh
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Instance> instances;
  std::vector<std::string> class_names = {"unlabelled"};  ///< index = class_id
};

/// Whether a sensor sees the instance.
bool is_visible(const Instance& instance, std::uint32_t sensor_id);

/// The material of a triangle of an instance.
const Material& material_of(const Scene& scene, const Instance& instance, std::uint32_t triangle);

/// The bounding box of all instances in the world frame, in metres; empty for an empty scene.
Eigen::AlignedBox3d bounds(const Scene& scene);

/// Throws Error with the first invalid index, size, scale or pose.
void validate(const Scene& scene);

}  // namespace glidar
