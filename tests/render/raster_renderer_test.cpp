// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Raster only: single precision at extremes, and both methods of drawing.
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
              .hit_columns = kAllHitColumns,
              .cull_back_faces = cull_back_faces},
             hits);
  return hits;
}

/// Number of beams that report another triangle than rays.
std::size_t others(const Hits& drawn, const Hits& cast) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cast.primitive.size(); ++i) {
    const bool is_same =
        drawn.instance[i] == cast.instance[i] && drawn.primitive[i] == cast.primitive[i];
    count += is_same ? 0U : 1U;
  }
  return count;
}

TEST(RasterRenderer, ADistantObjectDoesNotHideANearOne) {
  Scene scene = builtin_scene("sphere");
  add_model(scene, make_builtin_model("sphere"));
  add_model(scene, make_builtin_model("box"));
  scene.instances[0].world_from_object.translation() = Eigen::Vector3d(0.0, 0.0, 3.0);
  scene.instances[1].world_from_object.translation() = Eigen::Vector3d(0.2, 0.0, 6.0);
  scene.instances[2].world_from_object.translation() = Eigen::Vector3d(0.0, 1e13, 1e13);
  const Beams beams = camera_beams(160, 120, 150.0);
  const Hits drawn = cast_by("raster", scene, beams, Pose::Identity());
  scene.instances.pop_back();
  EXPECT_LE(others(drawn, cast_by("rays", scene, beams, Pose::Identity())), 2U);
}

TEST(RasterRenderer, WorksFromInsideAndBetweenTriangles) {
  Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(160, 120, 60.0);
  const Eigen::Vector3d middle = bounds(scene).center();
  testing::Draws draws(4);
  std::size_t hits = 0;
  std::size_t differ = 0;
  for (int i = 0; i < 12; ++i) {  // from the middle to close under the surface
    const Pose pose = look_at(middle + 0.08 * i * draws.direction(), middle + draws.direction(),
                              Eigen::Vector3d::UnitZ());
    const Hits cast = cast_by("rays", scene, beams, pose);
    differ += others(cast_by("raster", scene, beams, pose), cast);
    for (const double range : cast.range_m) hits += std::isnan(range) ? 0U : 1U;
  }
  EXPECT_GT(hits, 100'000U);
  EXPECT_LE(differ, hits / 20'000);
}

TEST(RasterRenderer, CullsBackFacesAsRaysDo) {
  const Scene scene = builtin_scene("torus");
  const Beams beams = camera_beams(160, 120, 100.0);
  const Pose pose = look_at({1.0, 0.0, 0.1}, {0.0, 1.0, 0.0}, Eigen::Vector3d::UnitZ());
  const Hits cast = cast_by("rays", scene, beams, pose, true);
  EXPECT_LE(others(cast_by("raster", scene, beams, pose, true), cast), 2U);
}

TEST(RasterRenderer, AlphaMasksWorkOnTrianglesOfEverySize) {
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
    const Hits cast = cast_by("rays", scene, beams, pose);
    EXPECT_LE(others(cast_by("raster", scene, beams, pose), cast), 8U) << distance;
  }
}

/// A scene of one mesh.
Scene scene_of_mesh(std::vector<Eigen::Vector3f> positions_m, std::vector<Triangle> triangles) {
  Scene scene = builtin_scene("plane");
  Mesh mesh;
  mesh.positions_m = std::move(positions_m);
  mesh.triangles = std::move(triangles);
  scene.meshes[0] = std::move(mesh);
  return scene;
}

/// Two triangles for each square of a grid of (side + 1)^2 vertices.
std::vector<Triangle> grid(std::uint32_t side) {
  std::vector<Triangle> triangles;
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t col = 0; col < side; ++col) {
      const std::uint32_t at = row * (side + 1) + col;
      triangles.push_back({at, at + 1, at + side + 1});
      triangles.push_back({at + side + 1, at + 1, at + side + 2});
    }
  }
  return triangles;
}

TEST(RasterRenderer, ATriangleSeenEdgeOnHidesNothing) {
  // A floor, and a wall on it; the sensor is on the floor.
  const Scene scene = scene_of_mesh({{-4, -3, 0},
                                     {4, -3, 0},
                                     {4, 3, 0},
                                     {-4, 3, 0},
                                     {3, -3, -1},
                                     {3, 3, -1},
                                     {3, 3, 3},
                                     {3, -3, 3}},
                                    {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
  const Beams beams = camera_beams(64, 64, 55.0);
  const Pose pose = look_at({0.3, 0.2, 0.0}, {3.0, 0.3, -0.2}, Eigen::Vector3d::UnitZ());
  const Hits drawn = cast_by("raster", scene, beams, pose);
  for (const double range : drawn.range_m) EXPECT_FALSE(range < 2.0);
  EXPECT_EQ(others(drawn, cast_by("rays", scene, beams, pose)), 0U);
}

TEST(RasterRenderer, AMeshOfSmallAndVastTrianglesDoesNotLeak) {
  // Fine ground below the sensor, surrounded by triangles of up to 3 km.
  constexpr std::uint32_t kSide = 6;
  std::vector<Eigen::Vector3f> positions;
  for (std::uint32_t row = 0; row <= kSide; ++row) {
    for (std::uint32_t col = 0; col <= kSide; ++col) {
      positions.emplace_back(0.05F * static_cast<float>(col) - 0.15F,
                             0.05F * static_cast<float>(row) - 0.15F, 0.0F);
    }
  }
  std::vector<Triangle> triangles = grid(kSide);
  const auto vertex = [](std::uint32_t row, std::uint32_t col) { return row * (kSide + 1) + col; };
  const auto far = static_cast<std::uint32_t>(positions.size());
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    positions.emplace_back(3000.0F * static_cast<float>(x), 3000.0F * static_cast<float>(y), 0.0F);
  }
  for (std::uint32_t i = 0; i < kSide; ++i) {
    triangles.push_back({vertex(0, i + 1), vertex(0, i), far});
    triangles.push_back({vertex(i + 1, kSide), vertex(i, kSide), far + 1});
    triangles.push_back({vertex(kSide, i), vertex(kSide, i + 1), far + 2});
    triangles.push_back({vertex(i, 0), vertex(i + 1, 0), far + 3});
  }
  triangles.push_back({far, far + 1, vertex(0, kSide)});
  triangles.push_back({far + 1, far + 2, vertex(kSide, kSide)});
  triangles.push_back({far + 2, far + 3, vertex(kSide, 0)});
  triangles.push_back({far + 3, far, vertex(0, 0)});
  const Scene scene = scene_of_mesh(std::move(positions), std::move(triangles));
  const Beams beams = camera_beams(1000, 1000, 1000.0);
  const Pose pose = look_at({0.013, 0.021, 1.0}, {0.013, 0.021, 0.0}, Eigen::Vector3d::UnitX());
  const Hits drawn = cast_by("raster", scene, beams, pose);
  for (std::size_t i = 0; i < beams.size(); ++i) ASSERT_NEAR(drawn.depth_m[i], 1.0, 1e-9) << i;
}

TEST(RasterRenderer, CreasesSmallerThanAPixelEqualBruteForce) {
  // Noise on a grid, with silhouettes everywhere, compared with brute force from near and far.
  constexpr std::uint32_t kSide = 60;
  testing::Draws draws(8);
  std::vector<Eigen::Vector3f> positions;
  for (std::uint32_t row = 0; row <= kSide; ++row) {
    for (std::uint32_t col = 0; col <= kSide; ++col) {
      positions.emplace_back(static_cast<float>(col) / kSide, static_cast<float>(row) / kSide,
                             static_cast<float>(0.2 * draws.next()));
    }
  }
  const Scene scene = scene_of_mesh(std::move(positions), grid(kSide));
  const Beams beams = camera_beams(70, 70, 100.0);
  const testing::BruteForce brute_force(scene);
  std::size_t compared = 0;
  for (const double distance : {1.0, 2.0, 4.0}) {
    const Pose pose =
        look_at(Eigen::Vector3d(0.5, 0.5, 0.0) + distance * Eigen::Vector3d(1, 0.3, 0.2),
                {0.5, 0.5, 0.1}, Eigen::Vector3d::UnitZ());
    const Hits drawn = cast_by("raster", scene, beams, pose);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const testing::Judged truth =
          brute_force.judge(pose.translation(), pose.linear() * beams.directions[i]);
      constexpr double kRounding_m = 1e-9;
      if (truth.border_m < kRounding_m) continue;
      ++compared;
      EXPECT_EQ(drawn.primitive[i], truth.primitive) << distance << ", beam " << i;
    }
  }
  EXPECT_GT(compared, 14'000U);
}

}  // namespace
}  // namespace glidar
