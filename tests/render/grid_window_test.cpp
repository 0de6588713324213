// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/grid_window.hpp>
#include <render/renderer_suite.hpp>

#include <random>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

GridWindow window(const Scene& scene, const Beams& beams, const Pose& world_from_sensor,
                  std::span<const std::uint8_t> present = {}) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Mesh& mesh : scene.meshes) boxes.push_back(bounds(mesh));
  Resolver resolver(scene);
  resolver.set_poses(world_from_sensor, {});
  PlanePoints points;
  find_plane_points(beams, points);
  return visible_window(resolver, boxes, present, points);
}

bool holds(const GridWindow& window, double row, double col) {
  return window.first_row <= row && row < window.end_row && window.first_col <= col &&
         col < window.end_col;
}

Pose looking(const Eigen::Vector3d& from) {
  return look_at(from, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
}

TEST(GridWindow, ContainsEveryVisibleVertex) {
  const Scene scene = builtin_scene("asteroid");
  const Beams beams = camera_beams(80, 60, 50.0);
  const PinholeIntrinsics& k = *beams.pinhole;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int view = 0; view < 20; ++view) {
    const Eigen::Vector3d way(normal(random), normal(random), normal(random));
    const Pose pose = looking(12.0 * way.normalized());
    const GridWindow seen = window(scene, beams, pose);
    EXPECT_GT(seen.first_row, 0U);
    EXPECT_LT(seen.end_col, k.width);
    for (const Eigen::Vector3f& vertex : scene.meshes[0].positions_m) {
      const Eigen::Vector3d p = pose.inverse() * (vertex.cast<double>() + scene.meshes[0].origin_m);
      const double col = k.fx * p.x() / p.z() + k.cx - k.pixel_centre;
      const double row = k.fy * p.y() / p.z() + k.cy - k.pixel_centre;
      ASSERT_TRUE(holds(seen, std::floor(row), std::floor(col))) << row << ' ' << col;
      ASSERT_TRUE(holds(seen, std::ceil(row), std::ceil(col))) << row << ' ' << col;
    }
  }
}

/// The instances around the middle come last, so their boxes are partly covered.
TEST(GridWindow, ContainsEveryVisibleVertexOfManyInstances) {
  Scene scene = builtin_scene("box");
  const Beams beams = camera_beams(300, 200, 90.0);
  const PinholeIntrinsics& k = *beams.pinhole;
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  for (int view = 0; view < 20; ++view) {
    Instance instance = scene.instances[0];
    scene.instances.clear();
    for (int i = 0; i < 40; ++i) {
      instance.scale = 0.05 + 0.1 * std::abs(normal(random));
      instance.world_from_object.translation() =
          2.0 / (1.0 + 0.1 * i) * Eigen::Vector3d(normal(random), normal(random), normal(random));
      scene.instances.push_back(instance);
    }
    const Pose pose = looking({20.0, 3.0, 4.0});
    const GridWindow seen = window(scene, beams, pose);
    EXPECT_LT(seen.end_row - seen.first_row, k.height);
    for (const Instance& one : scene.instances) {
      for (const Eigen::Vector3f& vertex : scene.meshes[0].positions_m) {
        const Eigen::Vector3d p =
            pose.inverse() * (one.world_from_object * (one.scale * vertex.cast<double>()));
        const double col = k.fx * p.x() / p.z() + k.cx - k.pixel_centre;
        const double row = k.fy * p.y() / p.z() + k.cy - k.pixel_centre;
        ASSERT_TRUE(holds(seen, std::floor(row), std::floor(col))) << row << ' ' << col;
        ASSERT_TRUE(holds(seen, std::ceil(row), std::ceil(col))) << row << ' ' << col;
      }
    }
  }
}

TEST(GridWindow, IsTheWholeGridIfSomethingIsBesideOrBehindTheCamera) {
  const Scene scene = builtin_scene("box");  // half side 1
  const Beams beams = camera_beams(8, 8, 60.0);
  const GridWindow whole = window(scene, beams, looking({0.5, 0.0, 0.0}));
  EXPECT_TRUE(holds(whole, 0, 0));
  EXPECT_TRUE(holds(whole, 7, 7));
}

TEST(GridWindow, IsEmptyIfNothingIsEnabledOrInView) {
  const Scene scene = builtin_scene("box");
  const Beams beams = camera_beams(8, 8, 20.0);
  const std::array<std::uint8_t, 1> absent = {0};
  const GridWindow grid{.end_row = 8, .end_col = 8};
  EXPECT_FALSE(window(scene, beams, looking({9.0, 0.0, 0.0}), absent).meets(grid));
  Pose beside = looking({90.0, 0.0, 0.0});
  beside.translation() += 60.0 * beside.linear().col(0);
  const GridWindow inner{.first_row = 0, .end_row = 8, .first_col = 2, .end_col = 8};
  EXPECT_FALSE(window(scene, beams, beside).meets(inner));
}

TEST(GridWindow, IsTheWholeGridForOtherBeams) {
  Beams beams = camera_beams(8, 8, 20.0);
  beams.pinhole.reset();
  EXPECT_TRUE(holds(window(builtin_scene("box"), beams, looking({9.0, 0.0, 0.0})), 7, 0));
}

}  // namespace
}  // namespace glidar
