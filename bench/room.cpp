// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "room.hpp"

#include <glidar/io/model/builtin_models.hpp>

namespace glidar::bench {

Scene make_room() {
  Scene scene;
  add_model(scene, make_builtin_model("box"));
  scene.instances[0].scale = 4.0;
  scene.instances[0].world_from_object.translation().z() = 2.5;
  const auto put = [&](const char* model, double scale, const Eigen::Vector3d& at_m) {
    add_model(scene, make_builtin_model(model));
    scene.instances.back().scale = scale;
    scene.instances.back().world_from_object.translation() = at_m;
  };
  put("asteroid", 0.7, {2.2, 1.0, -0.8});
  put("torus", 0.6, {-2.0, 2.0, -0.5});
  put("torus", 0.4, {1.0, -2.5, 0.1});
  put("sphere", 0.5, {-1.5, -2.0, 0.0});
  put("box", 0.4, {3.0, -2.0, -0.9});
  return scene;
}

}  // namespace glidar::bench
