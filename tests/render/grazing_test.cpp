// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Beams that hit triangles edge-on, close to their start, or where they have no width.
#include <render/renderer_suite.hpp>

#include <cmath>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;
using testing::Draws;

class GrazingBeams : public testing::RendererSuite {};

TEST_P(GrazingBeams, ATriangleWithoutWidthBetweenOthersLeavesNoHoles) {
  for (const float width : {1e-6F, 1e-12F, 1e-30F, 0.0F}) {
    Scene scene = builtin_scene("plane");
    Mesh& mesh = scene.meshes[0];
    mesh = Mesh();
    mesh.positions_m = {{-64, 0, 0}, {0, width, 0}, {64, 0, 0}, {0, -64, 0}, {0, 64, 0}};
    mesh.triangles = {{0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {0, 2, 1}};
    // the middle row of 43 is along the line
    const Hits hits = cast(scene, camera_beams(61, 43, 60.0),
                           look_at({0.1, 0.0, 5.0}, {0.3, 0.0, 0.0}, Eigen::Vector3d::UnitY()));
    for (std::size_t i = 0; i < hits.range_m.size(); ++i) {
      EXPECT_NEAR(hits.range_m[i], 5.0, 1.0) << i << ", " << width;
      EXPECT_TRUE(hits.normal[i].allFinite()) << i << ", " << width;
      EXPECT_TRUE(hits.barycentrics[i].allFinite()) << i << ", " << width;
    }
  }
}

TEST_P(GrazingBeams, RangesArePositiveCloseToASurface) {
  const Scene scene = builtin_scene("asteroid");
  const Mesh& mesh = scene.meshes[0];
  const std::unique_ptr<Renderer> renderer = GrazingBeams::renderer(scene);
  const Beams beams = camera_beams(16, 16, 8.0);
  Draws draws(21);
  for (int i = 0; i < 60; ++i) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(
        draws.next() * static_cast<double>(mesh.triangles.size()))];
    const Eigen::Vector3d middle =
        mesh.origin_m +
        (mesh.positions_m[a] + mesh.positions_m[b] + mesh.positions_m[c]).cast<double>() / 3.0;
    const Eigen::Vector3d eye =
        middle + std::pow(10.0, -18.0 + 9.0 * draws.next()) * draws.direction();
    Hits hits;
    renderer->cast(
        {.beams = beams,
         .world_from_sensor = look_at(eye, eye + draws.direction(), Eigen::Vector3d::UnitZ()),
         .hit_columns = kAllHitColumns},
        hits);
    for (const double range_m : hits.range_m) EXPECT_FALSE(range_m <= 0.0) << range_m;
  }
}

INSTANTIATE_TEST_SUITE_P(All, GrazingBeams, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& kind) { return kind.param; });

}  // namespace
}  // namespace glidar
