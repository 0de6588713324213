// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Changes of materials that are refused.
#include <glidar/core/error.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <support/source_folder.hpp>

#include <gtest/gtest.h>

#include <filesystem>

namespace glidar {
namespace {

TEST(SetMaterials, ChangesNothingWhenOneOfThemIsRefused) {
  Scene scene;
  const auto file = std::filesystem::path(kSourceFolder) / "models/satellite/satellite.obj";
  ModelOptions options;
  options.use_cache = false;
  add_model(scene, load_model(file.string(), options, {}));
  const Scene before = scene;
  const Instance& changed = scene.instances[0];
  ASSERT_GT(changed.materials.size(), 1U);
  const std::string first = scene.materials[changed.materials.front()].name;
  const std::string last = scene.materials[changed.materials.back()].name;
  const std::string text =
      "{" + first + ": {mirror: 1}, " + last + ": {noise_texture: nowhere.png}}";
  EXPECT_THROW(set_materials(scene, 0, text), Error);
  EXPECT_EQ(scene.materials.size(), before.materials.size());
  EXPECT_EQ(scene.textures.size(), before.textures.size());
  EXPECT_EQ(changed.materials, before.instances[0].materials);
}

}  // namespace
}  // namespace glidar
