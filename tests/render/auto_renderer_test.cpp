// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/renderer_suite.hpp>
#include <render/same_hits.hpp>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::expect_same_hits;

Hits cast_by(const char* kind, const Scene& scene, const Beams& beams, const Pose& pose) {
  Hits hits;
  make_renderer(scene, {.kind = kind, .threads = 2})
      ->cast({.beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns}, hits);
  return hits;
}

/// Expects that rays, the raster and `auto` report the same bits in every column.
void expect_same_by_all(const Scene& scene, const Beams& beams, const Pose& pose) {
  const Hits rays = cast_by("rays", scene, beams, pose);
  EXPECT_GT(expect_same_hits(cast_by("raster", scene, beams, pose), rays), 0U);
  expect_same_hits(cast_by("auto", scene, beams, pose), rays);
}

// Beams along the edges of a box.
const Pose kAlongEdges = look_at({4.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());

TEST(AutoRenderer, TheChoiceOfTheRendererCannotChangeAnyBitOfACamera) {
  for (const char* model : {"asteroid", "box", "sphere"}) {
    const Scene scene = builtin_scene(model);
    expect_same_by_all(scene, camera_beams(201, 151, 150.0), kAlongEdges);  // few triangles
    expect_same_by_all(scene, camera_beams(9, 9, 8.0), kAlongEdges);        // many
  }
}

TEST(AutoRenderer, EqualsRaysForBeamsThatARasterCannotDraw) {
  const Scene scene = builtin_scene("asteroid");
  Beams beams = camera_beams(201, 151, 150.0);
  beams.origins_m.assign(beams.size(), Eigen::Vector3d(0.01, 0.0, 0.0));
  expect_same_hits(cast_by("auto", scene, beams, kAlongEdges),
                   cast_by("rays", scene, beams, kAlongEdges));
}

TEST(AutoRenderer, ChoosesTheRendererForEachCast) {
  const Scene scene = builtin_scene("asteroid");
  const auto renderer = make_renderer(scene, {.kind = "auto", .threads = 2});
  const Beams few = camera_beams(9, 9, 8.0);
  const Beams many = camera_beams(201, 151, 150.0);
  Hits hits;
  for (int i = 0; i < 2; ++i) {
    for (const Beams* beams : {&many, &few}) {
      renderer->cast(
          {.beams = *beams, .world_from_sensor = kAlongEdges, .hit_columns = kAllHitColumns}, hits);
      expect_same_hits(hits, cast_by("auto", scene, *beams, kAlongEdges));
    }
  }
}

}  // namespace
}  // namespace glidar
