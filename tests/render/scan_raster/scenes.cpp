// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/scan_raster/scenes.hpp>

#include <render/renderer_suite.hpp>

#include <cmath>
#include <utility>

namespace glidar::testing {

Scene make_room() {
  Scene scene = builtin_scene("box");
  scene.instances[0].scale = 4.0;
  scene.instances[0].world_from_object.translation().z() = 2.5;
  const auto put = [&](const char* model, double scale, const Eigen::Vector3d& at_m) {
    add_model(scene, make_builtin_model(model));
    scene.instances.back().scale = scale;
    scene.instances.back().world_from_object = turned(0.3 + scale, {1.0, 2.0, 0.5}, at_m);
  };
  put("asteroid", 0.7, {2.2, 1.0, -0.8});
  put("torus", 0.6, {-2.0, 2.0, -0.5});
  put("torus", 0.004, {0.2, -0.25, 0.01});
  put("sphere", 0.5, {-1.5, -2.0, 0.0});
  put("box", 0.4, {3.0, -2.0, -0.9});
  return scene;
}

Scene make_soup(std::uint64_t seed, std::size_t count, double size_m) {
  Draws draws(seed);
  Scene scene = builtin_scene("box");
  Mesh mesh;
  const auto point = [&](double scale) -> Eigen::Vector3d {
    return scale * Eigen::Vector3d(draws.next() - 0.5, draws.next() - 0.5, draws.next() - 0.5);
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3d corner = point(2.0 * size_m);
    const double width = size_m * std::pow(10.0, -3.0 * draws.next());
    const double length = size_m * std::pow(10.0, -3.0 * draws.next());
    const Eigen::Vector3d along = point(1.0);
    const Eigen::Vector3d across = i % 17 == 0 ? 2.0 * along : point(1.0);
    mesh.positions_m.push_back(corner.cast<float>());
    mesh.positions_m.push_back((corner + length * along).cast<float>());
    mesh.positions_m.push_back((corner + width * across).cast<float>());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    if (i % 5 == 0) mesh.triangles.push_back({3 * i + 1, 3 * i + 2, 3 * i});
  }
  scene.meshes[0] = std::move(mesh);
  return scene;
}

}  // namespace glidar::testing
