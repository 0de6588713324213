// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Beams that pass silhouettes by less than a rasterizer's grid have the same hits as brute force in
// double.
#include <glidar/render/silhouettes.hpp>
#include <render/renderer_suite.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

using testing::camera_beams;
using testing::Draws;
using testing::Judged;
using testing::turned;

constexpr std::uint32_t kSide = 64;

/// Thin and wide triangles at many depths in front of two walls; one edge of each passes the beam
/// of a pixel by up to 1/200 of a pixel, on either side.
Scene triangles_at_beams(std::uint64_t seed) {
  Draws draws(seed);
  Scene scene = testing::builtin_scene("plane");
  Mesh& mesh = scene.meshes[0];
  mesh = Mesh();
  const auto add = [&](const Eigen::Vector2d& pixel, double depth_m) {
    const Eigen::Vector2d at = (pixel.array() + 0.5 - 0.5 * kSide) / kSide * depth_m;
    mesh.positions_m.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()),
                                  static_cast<float>(depth_m));
  };
  for (int i = 0; i < 1500; ++i) {
    const double angle = 2.0 * std::numbers::pi * draws.next();
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d beam(std::floor(kSide * draws.next()), std::floor(kSide * draws.next()));
    const Eigen::Vector2d on_border = beam + 0.01 * (draws.next() - 0.5) * across;
    const double depth_m = 1.0 + 2.0 * draws.next();
    add(on_border - 5.0 * draws.next() * along, depth_m);
    add(on_border + 5.0 * draws.next() * along, depth_m * (1.0 + 0.1 * draws.next()));
    add(on_border + std::pow(10.0, -2.0 + 2.5 * draws.next()) * across, depth_m);
  }
  for (const double depth_m : {5.0, 7.0}) {  // two walls, the nearer one on the left half
    const double right = depth_m < 6.0 ? 31.003 : 80.0;
    for (const auto& [u, v] : {std::pair{-20.0, -20.0},
                               {right, -20.0},
                               {right, 90.0},
                               {-20.0, -20.0},
                               {right, 90.0},
                               {-20.0, 90.0}}) {
      add({u, v}, depth_m);
    }
  }
  for (std::uint32_t i = 0; i + 2 < mesh.positions_m.size(); i += 3) {
    mesh.triangles.push_back({i, i + 1, i + 2});
  }
  return scene;
}

class Silhouettes : public testing::RendererSuite {
 protected:
  /// Beams this near to an edge are not compared, because the reference rays start 2^-20 of the
  /// scene's radius beside the beam; brute force has errors of some roundings of double.
  static double room_m(const Scene& scene) {
    return GetParam() == "rays" ? 0x1p-18 * bounds(scene).diagonal().norm() : 1e-12;
  }

  static void expect_brute_force(const Scene& scene, const Beams& beams, const Pose& pose,
                                 std::size_t least_compared) {
    const Hits hits = cast(scene, beams, pose);
    const testing::BruteForce brute_force(scene);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const Judged truth =
          brute_force.judge(pose.translation(), pose.linear() * beams.directions[i]);
      if (truth.border_m < room_m(scene)) continue;
      ++compared;
      ASSERT_EQ(hits.instance[i], truth.instance) << "beam " << i;
      ASSERT_EQ(hits.primitive[i], truth.primitive) << "beam " << i;
      if (truth.instance == kInvalidId) continue;
      EXPECT_NEAR(hits.range_m[i], truth.range_m, 1e-12 * truth.range_m) << "beam " << i;
    }
    EXPECT_GE(compared, least_compared);
  }
};

TEST_P(Silhouettes, BeamsWithinAGridStepOfAnEdgeEqualBruteForce) {
  const Beams beams = camera_beams(kSide, kSide, kSide);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Scene scene = triangles_at_beams(seed);
    // Single precision rejects a fraction of these beams; the others compare all except ties.
    expect_brute_force(scene, beams, Pose::Identity(),
                       GetParam() == "rays" ? beams.size() * 8 / 10 : beams.size() - 5);
  }
}

TEST_P(Silhouettes, DistantEdgesEqualBruteForce) {
  const Scene scene = triangles_at_beams(4);
  const double distance_m = 2000.0;
  const Beams beams = camera_beams(kSide, kSide, 10.0 * distance_m);
  const Pose pose = turned(0.2, {0.1, 1.0, 0.0}, {-distance_m * std::sin(0.2), 0.0, -distance_m});
  expect_brute_force(scene, beams, pose, beams.size() * 9 / 10);
}

/// A cone with so many triangles around its tip that most beams pass edges of several.
Mesh cone(std::uint32_t count) {
  Mesh fan;
  fan.positions_m.emplace_back(0.0F, 0.0F, 1.0F);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    fan.positions_m.emplace_back(static_cast<float>(std::cos(angle)),
                                 static_cast<float>(std::sin(angle)), 0.0F);
    fan.triangles.push_back({0, i + 1, (i + 1) % count + 1});
  }
  return fan;
}

TEST_P(Silhouettes, AConeOfManyTrianglesEqualsBruteForce) {
  Scene scene = testing::builtin_scene("plane");
  scene.meshes[0] = cone(3000);
  const Pose pose = look_at({0.4, 0.3, 6.0}, {0.0, 0.0, 0.5}, Eigen::Vector3d::UnitY());
  const Beams beams = camera_beams(32, 32, 80.0);
  expect_brute_force(scene, beams, pose, GetParam() == "rays" ? 10 : 600);
}

INSTANTIATE_TEST_SUITE_P(All, Silhouettes, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

TEST(MeshEdges, AClosedMeshHasTwoTrianglesAtEachEdgeAndAnOpenOneEnds) {
  const Scene box = testing::builtin_scene("box");
  const std::vector<MeshEdge> closed = mesh_edges(box.meshes[0]);
  EXPECT_EQ(closed.size(), 18U);  // 12 and a diagonal a face, though its faces share no vertices
  for (const MeshEdge& edge : closed) EXPECT_NE(edge.second, MeshEdge::kNone);
  const Scene plane = testing::builtin_scene("plane");
  const std::vector<MeshEdge> open = mesh_edges(plane.meshes[0]);
  EXPECT_EQ(open.size(), 5U);
  EXPECT_EQ(std::count_if(open.begin(), open.end(),
                          [](const MeshEdge& edge) { return edge.second == MeshEdge::kNone; }),
            4);
}

TEST(MeshEdges, AFanOfAHundredThousandTrianglesHasItsEdges) {
  // The cost is that of a sort: over the pairs of triangles around the hub it would take minutes.
  constexpr std::uint32_t kCount = 100'000;
  const Mesh fan = cone(kCount);
  const std::vector<MeshEdge> edges = mesh_edges(fan);
  EXPECT_EQ(edges.size(), 2 * kCount);
  EXPECT_EQ(std::count_if(edges.begin(), edges.end(),
                          [](const MeshEdge& edge) { return edge.second == MeshEdge::kNone; }),
            kCount);
}

TEST(MeshEdges, AnEdgeOfThreeTrianglesCountsAsOpen) {
  Mesh mesh;
  mesh.positions_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F},  {0.0F, 1.0F, 0.0F},
                      {0.0F, 0.0F, 1.0F}, {0.0F, -1.0F, 0.0F}, {1.0F, 0.0F, 0.0F}};
  mesh.triangles = {{2, 0, 1}, {0, 3, 5}, {1, 0, 4}, {0, 0, 4}};
  const std::vector<MeshEdge> edges = mesh_edges(mesh);
  EXPECT_EQ(edges.size(), 7U);
  const auto shared = std::find_if(edges.begin(), edges.end(), [](const MeshEdge& edge) {
    return edge.from == 0 && edge.to == 1;
  });
  ASSERT_NE(shared, edges.end());
  EXPECT_EQ(shared->first, 0U);
  EXPECT_EQ(shared->second, MeshEdge::kNone);
}

TEST(SilhouettePixels, AreNearTheOutlineAndNotNearInnerEdges) {
  // A square of 2 m, 4 m away, seen 32 pixels wide: its left edge passes pixel centres by 0.003.
  Scene scene = testing::builtin_scene("plane");
  scene.instances[0].world_from_object.translation() =
      Eigen::Vector3d(-0.5 / 64.0 * 4.0 + 0.003 / 64.0 * 4.0, 0.01, 4.0);
  const Beams beams = camera_beams(kSide, kSide, kSide);
  Resolver resolver(scene);
  const std::vector<std::vector<MeshEdge>> edges = {mesh_edges(scene.meshes[0])};
  const CastRequest request{.beams = beams};
  resolver.set_poses(Pose::Identity(), {});
  SilhouettePixels pixels(1.0 / 128.0);
  ThreadPool thread_pool(2);
  const std::vector<std::size_t> found =
      pixels.find(request, resolver, edges, {0, 0, kSide, kSide}, thread_pool);
  EXPECT_EQ(found.size(), 64U);  // 32 rows at the left and at the right border
  for (const std::size_t pixel : found) {
    EXPECT_TRUE(pixel % kSide == 15 || pixel % kSide == 47) << pixel;
  }
  const std::vector<std::size_t> part =
      pixels.find(request, resolver, edges, {16, 16, 10, 40}, thread_pool);
  EXPECT_EQ(part.size(), 10U);
}

}  // namespace
}  // namespace glidar
