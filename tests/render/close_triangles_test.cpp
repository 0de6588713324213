// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Coincident triangles of one mesh, and cameras that cannot resolve their gap.
#include <glidar/render/close_triangles.hpp>
#include <glidar/render/depth_range.hpp>
#include <render/renderer_suite.hpp>

#include <memory>

namespace glidar {
namespace {

using testing::builtin_scene;
using testing::camera_beams;

constexpr double kBand_px = 1.0 / 128.0;

class CloseTrianglesTest : public ::testing::Test {
 protected:
  /// The number of close triangles of the scene, seen by 100x100 beams from (0, 0, distance).
  std::size_t close_from(double distance_m) {
    resolver_ = std::make_unique<Resolver>(scene_);
    const rays::SceneTrees trees(*resolver_, thread_pool_);
    const std::vector<Eigen::AlignedBox3d> boxes = {local_box(scene_.meshes[0])};
    CloseTriangles close_triangles(*resolver_, trees, boxes, thread_pool_);
    const Beams beams = camera_beams(100, 100, 100.0);
    const CastRequest request{
        .beams = beams,
        .world_from_sensor = look_at(distance_m * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(),
                                     Eigen::Vector3d::UnitY())};
    resolver_->set_poses(request.world_from_sensor, {});
    close_triangles.prepare(request, kBand_px);
    std::size_t close = 0;
    for (std::uint32_t i = 0; i < scene_.meshes[0].triangles.size(); ++i) {
      close += close_triangles.is_close(0, i) ? 1 : 0;
    }
    return close;
  }

  /// A square of 2 m, and a smaller one above its middle.
  void set_sheets(float height_m) {
    scene_ = builtin_scene("plane");
    Mesh& mesh = scene_.meshes[0];
    mesh = Mesh();
    for (const auto& [half, z] : {std::pair{1.0F, 0.0F}, std::pair{0.3F, height_m}}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
      for (const auto& [x, y] :
           {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
        mesh.positions_m.emplace_back(x, y, z);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }

  ThreadPool thread_pool_{2};
  Scene scene_;
  std::unique_ptr<Resolver> resolver_;
};

TEST_F(CloseTrianglesTest, NeighboursOnASurfaceAreNotClose) {
  for (const char* model : {"plane", "box", "torus", "asteroid"}) {
    scene_ = builtin_scene(model);
    EXPECT_EQ(close_from(4.0), 0U) << model;
  }
}

TEST_F(CloseTrianglesTest, CoincidentTrianglesAreCloseFromAnyDistance) {
  set_sheets(0.0F);
  EXPECT_EQ(close_from(2.0), 4U);
  EXPECT_EQ(close_from(50.0), 4U);
}

TEST_F(CloseTrianglesTest, ParallelTrianglesAreCloseIfTheirGapIsBelowAPixel) {
  set_sheets(1e-3F);
  EXPECT_EQ(close_from(2.0), 0U);  // a pixel sees 20 mm
  EXPECT_EQ(close_from(8.0), 4U);  // 80 mm, of which the driver may move 1/64
}

TEST_F(CloseTrianglesTest, AMeshOfFewPixelsIsCompletelyClose) {
  scene_ = builtin_scene("box");
  EXPECT_EQ(close_from(1000.0), scene_.meshes[0].triangles.size());
}

TEST_F(CloseTrianglesTest, CopiesOfATriangleCountAsOne) {
  scene_ = builtin_scene("plane");
  std::vector<Triangle>& triangles = scene_.meshes[0].triangles;
  const std::vector<Triangle> once = triangles;
  for (const Triangle& t : once) triangles.push_back({t[0], t[2], t[1]});
  EXPECT_EQ(close_from(4.0), 0U);
}

}  // namespace
}  // namespace glidar
