// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/renderer_suite.hpp>
#include <render/scan_raster/scanner.hpp>

#include <cstring>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::Scanner;
using testing::scanner_beams;

Hits cast_by(const char* kind, const Scene& scene, const Beams& beams, const Pose& pose) {
  Hits hits;
  make_renderer(scene, {.kind = kind, .threads = 2})
      ->cast({.beams = beams, .world_from_sensor = pose, .hit_columns = kAllHitColumns}, hits);
  return hits;
}

bool are_same(const Hits& a, const Hits& b) {
  return a.primitive == b.primitive &&
         std::memcmp(a.range_m.data(), b.range_m.data(), a.range_m.size() * sizeof(double)) == 0;
}

// Beams along the edges of a box, where both renderers may report either neighbour.
const Pose kAlongEdges = look_at({4.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());

TEST(AutoRenderer, EqualsTheRasterForPinholesAndRaysForOtherBeams) {
  const Scene scene = builtin_scene("asteroid");
  Beams beams = camera_beams(201, 151, 150.0);
  EXPECT_TRUE(are_same(cast_by("auto", scene, beams, kAlongEdges),
                       cast_by("raster", scene, beams, kAlongEdges)));
  beams.pinhole.reset();
  EXPECT_TRUE(are_same(cast_by("auto", scene, beams, kAlongEdges),
                       cast_by("rays", scene, beams, kAlongEdges)));
}

TEST(AutoRenderer, CastsRaysIfTrianglesFarOutnumberBeams) {
  const Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(9, 9, 8.0);
  EXPECT_TRUE(are_same(cast_by("auto", scene, beams, kAlongEdges),
                       cast_by("rays", scene, beams, kAlongEdges)));
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
      EXPECT_TRUE(are_same(hits, cast_by("auto", scene, *beams, kAlongEdges)));
    }
  }
}

TEST(AutoRenderer, HitsDoNotDependOnWhetherBeamsRecur) {
  const Scene scene = builtin_scene("asteroid");
  const Beams beams = scanner_beams({.rows = 64, .cols = 1024});
  const auto renderer = make_renderer(scene, {.threads = 2});
  Hits hits;
  Hits once;
  renderer->cast({.beams = beams, .hit_columns = kAllHitColumns}, hits);
  renderer->cast({.beams = beams, .hit_columns = kAllHitColumns, .beams_recur = false}, once);
  EXPECT_TRUE(are_same(hits, once));
}

TEST(AutoRenderer, EqualsRaysForScannersOfAllKinds) {
  const Scene scene = builtin_scene("asteroid");
  for (const Scanner& scanner : {Scanner{.rows = 64, .cols = 1024},  // few triangles per beam
                                 Scanner{.rows = 4, .cols = 64},     // many
                                 Scanner{.rows = 16, .cols = 512, .origin_m = 0.05}}) {
    const Beams beams = scanner_beams(scanner);
    EXPECT_TRUE(are_same(cast_by("auto", scene, beams, Pose::Identity()),
                         cast_by("rays", scene, beams, Pose::Identity())));
  }
}

}  // namespace
}  // namespace glidar
