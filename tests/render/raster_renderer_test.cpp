// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// What is particular to the raster: single precision at extremes, and its two ways to draw.
#include <render/renderer_suite.hpp>

#include <cmath>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

Hits cast_by(const char* kind, const Scene& scene, const Beams& beams, const Pose& pose,
             bool cull_back_faces = false) {
  Hits hits;
  make_renderer(scene, {.kind = kind, .threads = 2})
      ->cast({.beams = beams,
              .world_from_sensor = pose,
              .fields = kAllHitFields,
              .cull_back_faces = cull_back_faces},
             hits);
  return hits;
}

/// Beams that tell another triangle than cast rays.
std::size_t others(const Hits& drawn, const Hits& cast) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cast.primitive.size(); ++i) {
    const bool is_same =
        drawn.instance[i] == cast.instance[i] && drawn.primitive[i] == cast.primitive[i];
    count += is_same ? 0U : 1U;
  }
  return count;
}

TEST(RasterRenderer, SomethingAsFarAsCanBeDoesNotHideWhatIsNear) {
  Scene scene = builtin_scene("sphere");
  add_model(scene, make_builtin_model("sphere"));
  add_model(scene, make_builtin_model("box"));
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(0.0, 0.0, 3.0);
  scene.instances[1].world_from_object.translation() = Eigen::Vector3d(0.2, 0.0, 6.0);
  scene.instances[2].world_from_object.translation() = Eigen::Vector3d(0.0, 1e13, 1e13);
  const Beams beams = camera_beams(160, 120, 150.0);
  const Hits drawn = cast_by("raster", scene, beams, Pose::Identity());
  scene.instances.pop_back();
  EXPECT_LE(others(drawn, cast_by("embree", scene, beams, Pose::Identity())), 2U);
}

TEST(RasterRenderer, SeesFromWithinAndFromBetweenTriangles) {
  Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(160, 120, 60.0);
  const Eigen::Vector3d middle = bounds(scene).center();
  testing::Draws draws(4);
  std::size_t hits = 0;
  std::size_t differ = 0;
  for (int i = 0; i < 12; ++i) {  // from the middle to close under the surface
    const Pose pose = look_at(middle + 0.08 * i * draws.direction(), middle + draws.direction(),
                              Eigen::Vector3d::UnitZ());
    const Hits cast = cast_by("embree", scene, beams, pose);
    differ += others(cast_by("raster", scene, beams, pose), cast);
    for (const double range : cast.range_m) hits += std::isnan(range) ? 0U : 1U;
  }
  EXPECT_GT(hits, 100'000U);
  EXPECT_LE(differ, hits / 20'000);
}

TEST(RasterRenderer, CullsBacksAsCastRaysDo) {
  const Scene scene = builtin_scene("torus");
  const Beams beams = camera_beams(160, 120, 100.0);
  const Pose pose = look_at({1.0, 0.0, 0.1}, {0.0, 1.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Hits cast = cast_by("embree", scene, beams, pose, true);
  EXPECT_LE(others(cast_by("raster", scene, beams, pose, true), cast), 2U);
}

TEST(RasterRenderer, HolesAreHolesInTrianglesOfEverySize) {
  Scene scene = builtin_scene("plane");
  scene.textures.push_back({.name = "mask",
                            .width = 3,
                            .height = 3,
                            .channels = 1,
                            .texels = {0, 255, 0, 255, 0, 255, 0, 255, 0}});
  Material& material = scene.materials[scene.instances[0].materials[0]];
  material.alpha_cutoff = 0.5F;
  material.alpha_texture = {.texture = 0, .filter = Filter::nearest};
  add_model(scene, make_builtin_model("plane"));
  scene.instances[1].world_from_object.translation().z() = -1.0;
  scene.instances[1].scale = 50.0;
  const Beams beams = camera_beams(100, 80, 80.0);
  for (const double distance : {60.0, 6.0, 1.0, 0.2}) {
    const Pose pose =
        look_at({0.3 * distance, 0.1, distance}, {0.05, 0.1, 0.0}, Eigen::Vector3d::UnitY());
    const Hits cast = cast_by("embree", scene, beams, pose);
    EXPECT_LE(others(cast_by("raster", scene, beams, pose), cast), 8U) << distance;
  }
}

}  // namespace
}  // namespace glidar
