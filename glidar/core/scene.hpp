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

/// One placed mesh: p_world = world_from_object * (scale * p_object).
struct Instance {
  std::string name;
  std::uint32_t mesh = 0;  ///< index into Scene::meshes
  Pose world_from_object = Pose::Identity();
  double scale = 1.0;                    ///< > 0, uniform
  std::uint32_t id = 0;                  ///< the user's number for it, written to clouds
  std::uint32_t class_id = 0;            ///< index into Scene::class_names
  std::vector<std::uint32_t> materials;  ///< material slot -> index into Scene::materials
};

/// Where a mesh came from; what the sidecar tells.
struct MeshSource {
  std::string path;  ///< the file, or "builtin:NAME"
  std::string hash;  ///< hash of the file's content, hexadecimal; empty for built-in meshes
  std::vector<std::string> files =
      {};                        ///< all that it was read from, textures too; canonical paths
  double metres_per_unit = 1.0;  ///< applied: what one unit of the file is
  bool unit_known = false;       ///< the file or the user specified it, it is not an assumption
  std::string up = {};           ///< applied: this axis of the file became z; empty: axes as in it
  /// The mesh is this multiple, along its own x, y and z, of mesh `unstretched` (an index into
  /// Scene::meshes).
  Eigen::Vector3d stretch = Eigen::Vector3d::Ones();
  std::uint32_t unstretched = 0;  ///< only used where stretch is not 1, 1, 1
};

/// The scale of an instance and the reach of its vertices, in metres from its origin, where it has
/// any: single precision holds products of both with room to spare.
inline constexpr double kMinScale = 1e-15;
inline constexpr double kMaxScale = 1e15;
inline constexpr double kMinReach_m = 1e-30;

/// All there is to see, as plain arrays and indices.
struct Scene {
  std::vector<Mesh> meshes;
  std::vector<MeshSource> sources;  ///< one per mesh
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Instance> instances;
  std::vector<std::string> class_names = {"unlabelled"};  ///< index = class_id
};

/// What a triangle of an instance is made of.
const Material& material_of(const Scene& scene, const Instance& instance, std::uint32_t triangle);

/// The box around all instances in the world frame; empty box for an empty scene.
Eigen::AlignedBox3d bounds(const Scene& scene);

/// Throws Error naming the first index, size, scale or pose that breaks a promise above.
void validate(const Scene& scene);

}  // namespace glidar
