// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/scene.hpp>

#include <utility>

namespace glidar::testing {

/// Adds an instance of a mesh; returns its material.
inline Material& add_mesh(Scene& scene, Mesh mesh) {
  const auto index = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  scene.sources.emplace_back();
  scene.materials.emplace_back();
  Instance& instance = scene.instances.emplace_back();
  instance.mesh = index;
  instance.materials = {index};
  return scene.materials.back();
}

/// Panels in front of a camera at the origin with boresight z.
struct PanelScene {
  Scene scene;

  /// Adds a two-sided parallelogram; returns its material.
  Material& add_panel(const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                      const Eigen::Vector3d& v) {
    Mesh mesh;
    mesh.origin_m = corner;
    mesh.positions_m = {Eigen::Vector3f::Zero(), u.cast<float>(), (u + v).cast<float>(),
                        v.cast<float>()};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return add_mesh(scene, std::move(mesh));
  }

  /// Adds a wall perpendicular to z at a range, from x0 to x1.
  Material& add_wall(double range_m, double x0 = -50.0, double x1 = 50.0) {
    return add_panel({x0, -50.0, range_m}, {x1 - x0, 0.0, 0.0}, {0.0, 100.0, 0.0});
  }
};

}  // namespace glidar::testing
