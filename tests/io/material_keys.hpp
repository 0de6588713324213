// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/config/scene_file.hpp>
#include <support/test_folder.hpp>

#include <string>

namespace glidar::testing {

/// The material that these keys of a scene file make of a box's.
inline Material material_of_keys(const std::string& keys) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml", "models:\n  - model: builtin:box\n    materials: {\"*\": {" + keys + "}}\n");
  const SceneFile loaded = load_scene_file(file, {}, {});
  return loaded.scene.materials[loaded.scene.instances[0].materials[0]];
}

}  // namespace glidar::testing
