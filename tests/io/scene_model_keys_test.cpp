// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Keys of a scene file's models that change their size and place, and paths.
#include <glidar/io/config/scene_plan.hpp>

#include "yaml_files.hpp"

#include <variant>

namespace glidar {
namespace {

ScenePlan plan(const TestFolder& folder, const std::string& content) {
  return read_scene_plan(folder.write("scene.yaml", content), {});
}

TEST(SceneFile, ReadsScalesPerAxisAndCentre) {
  const TestFolder folder;
  const ScenePlan scene =
      plan(folder, "models: [{model: a, scale: [1, 2.5, 0.5], centre: true}, {model: b}]\n");
  EXPECT_EQ(scene.instances[0].scale, Eigen::Vector3d(1.0, 2.5, 0.5));
  EXPECT_TRUE(scene.instances[0].options.centre);
  EXPECT_FALSE(scene.instances[1].options.centre);
}

TEST(SceneFile, SizesOfBuiltInModelsBecomePartOfTheirSource) {
  const TestFolder folder;
  const ScenePlan scene = plan(folder,
                               "models: [{model: 'builtin:box', size: [2, 1, 0.5]}, "
                               "{model: 'builtin:torus', radius: 3, tube_radius: 0.1}]\n");
  EXPECT_EQ(scene.instances[0].source, "builtin:box:size=2,1,0.5");
  EXPECT_EQ(scene.instances[0].name, "box");
  EXPECT_EQ(scene.instances[1].source, "builtin:torus:radius=3:tube_radius=0.1");
}

TEST(SceneFile, ParentsOfLinksAreResolvedLikeTheSystem) {
  const TestFolder folder;
  folder.write("deep/inner/x.txt", "");
  folder.write("deep/camera.yaml", "optics: {width: 5, height: 4, fov_deg: 30}\n");
  folder.write("camera.yaml", "optics: {width: 9, height: 4, fov_deg: 30}\n");
  std::filesystem::create_directory_symlink(folder.path() / "deep/inner", folder.path() / "link");
  const ScenePlan scene = plan(folder, "models: [{model: a}]\nsensor: link/../camera.yaml\n");
  EXPECT_EQ(std::get<Pinhole>(scene.sensors.at(0).sensor.optics).intrinsics.width, 5U);
}

}  // namespace
}  // namespace glidar
