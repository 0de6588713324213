// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/coincident_triangles.hpp>

#include <render/renderer_suite.hpp>

namespace glidar {
namespace {

using Indices = std::vector<std::uint32_t>;

Indices distinct(const Mesh& mesh) {
  return distinct_triangles(mesh, find_first_coincident(mesh));
}

/// Corners of a square, each twice.
Mesh square() {
  Mesh mesh;
  for (int copy = 0; copy < 2; ++copy) {
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}}) {
      mesh.positions_m.emplace_back(x, y, 0.0F);
    }
  }
  return mesh;
}

TEST(DistinctTriangles, KeepsAllTrianglesThatDiffer) {
  Mesh mesh = square();
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_TRUE(distinct(mesh).empty());
  EXPECT_TRUE(distinct(Mesh{}).empty());
}

TEST(DistinctTriangles, RemovesLaterTrianglesWithEqualCornersAndWinding) {
  Mesh mesh = square();
  mesh.triangles = {{0, 1, 2}, {1, 2, 0}, {0, 2, 3}, {4, 5, 6}, {6, 7, 4}};
  EXPECT_EQ(distinct(mesh), (Indices{0, 2}));
}

TEST(DistinctTriangles, KeepsOneTriangleOfEachWinding) {
  Mesh mesh = square();
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}, {5, 4, 6}, {0, 2, 3}, {0, 1, 2}};
  EXPECT_EQ(distinct(mesh), (Indices{0, 1, 3}));
}

class Copies : public testing::RendererSuite {};

TEST_P(Copies, ReportTheFirstTriangleOfEachPair) {
  Scene scene = testing::builtin_scene("asteroid");
  const Scene single = scene;
  std::vector<Triangle>& triangles = scene.meshes[0].triangles;
  const std::size_t count = triangles.size();
  for (std::size_t i = 0; i < count; ++i) {  // turned on, and inside out
    const auto [a, b, c] = triangles[i];
    triangles.push_back({b, c, a});
    triangles.push_back({c, b, a});
  }
  const Beams beams = testing::camera_beams(90, 70, 90.0);
  const Pose pose = look_at({2.0, -2.5, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
  for (const bool culls : {false, true}) {
    const auto cast_at = [&](const Scene& of) {
      Hits hits;
      renderer(of)->cast(
          {.beams = beams, .world_from_sensor = pose, .hit_columns = {}, .cull_back_faces = culls},
          hits);
      return hits;
    };
    const Hits twice = cast_at(scene);
    const Hits once = cast_at(single);
    EXPECT_EQ(twice.primitive, once.primitive) << culls;
    EXPECT_GT(std::count(once.instance.begin(), once.instance.end(), 0U), 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Copies, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace glidar
