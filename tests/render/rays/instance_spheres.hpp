// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>

#include <algorithm>
#include <vector>

namespace glidar::testing {

/// A sphere in the world around an instance.
struct Sphere {
  Eigen::Vector3d centre_m;
  double radius_m;
};

/// Spheres around all instances, larger than those by more than any rounding.
inline std::vector<Sphere> spheres_around(const Scene& scene, const Pose& world_from_sensor) {
  std::vector<Sphere> spheres;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Eigen::Vector3d at_m = instance.world_from_object.translation();
    double radius_m = 1e-12 * (at_m.norm() + world_from_sensor.translation().norm());
    for (std::uint32_t i = 0; i < mesh.positions_m.size(); ++i) {
      radius_m = std::max(radius_m, 1.01 * (instance.scale * vertex_m(mesh, i)).norm());
    }
    spheres.push_back({at_m, radius_m});
  }
  return spheres;
}

/// True where a ray cannot hit the instance, so that its triangles need no test.
inline bool is_beside(const Sphere& sphere, const Eigen::Vector3d& start_m,
                      const Eigen::Vector3d& direction) {
  return (sphere.centre_m - start_m).cross(direction).norm() > sphere.radius_m;
}

}  // namespace glidar::testing
