// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// An echo is mixed when it merges surfaces with a gap between them, and only then.
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/sensor/lidar/footprint.hpp>
#include <simulate/panels.hpp>
#include <support/preset.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

namespace glidar {
namespace {

using Eigen::Vector3d;
using testing::noise_free_preset;

Frame shoot(const Scene& scene, const Sensor& sensor, const Pose& world_from_sensor) {
  const auto renderer = make_renderer(scene, {.threads = 2});
  const Beams beams = make_beams(sensor);
  const Motion motion = static_motion(scene, world_from_sensor);
  Frame frame;
  testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
  return frame;
}

std::ptrdiff_t count(const Frame& frame, ReturnSource cause) {
  return std::count(frame.return_source.begin(), frame.return_source.end(), cause);
}

/// A wide pulsed camera along z; its pulses of 5 ns merge what is nearer than 0.64 m.
Sensor camera(std::uint32_t width, std::uint32_t height, double fov_rad) {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(width, height, fov_rad);
  sensor.lidar_equation = LidarEquation{.reference_reflectance = 0.01, .reference_range_m = 1e4};
  sensor.footprint = Footprint{.divergence_x_rad = 4e-3, .divergence_y_rad = 4e-3, .rings = 2};
  return sensor;
}

class OnAPlane : public ::testing::TestWithParam<const char*> {};

TEST_P(OnAPlane, NoReturnIsMixedAtAnyRange) {
  Scene scene;
  add_model(scene, make_builtin_model("plane"));
  scene.instances[0].scale = 300.0;
  for (const double height_m : {1.5, 2.0, 8.0}) {
    Pose pose = Pose::Identity();
    pose.translation().z() = height_m;
    const Frame frame = shoot(scene, noise_free_preset(GetParam()), pose);
    EXPECT_EQ(count(frame, ReturnSource::mixed_pixel), 0) << height_m;
    EXPECT_GT(count(frame, ReturnSource::surface), 1000) << height_m;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, OnAPlane,
                         ::testing::Values("OS1-128", "VLP-16", "HDL-64E-S3", "OS0-128"),
                         [](const auto& name) {
                           std::string text = name.param;
                           std::erase(text, '-');
                           return text;
                         });

/// A surface z = height(x, y) over a square around the origin, in triangles.
Mesh terrain(int cells, double side_m, const std::function<double(double, double)>& height_m) {
  Mesh mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = side_m * (static_cast<double>(i) / cells - 0.5);
      const double y = side_m * (static_cast<double>(j) / cells - 0.5);
      mesh.positions_m.push_back(Vector3d(x, y, height_m(x, y)).cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (cells + 1) + j); };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

Scene scene_of(const std::vector<Mesh>& meshes) {
  Scene scene;
  for (const Mesh& mesh : meshes) testing::add_mesh(scene, mesh);
  return scene;
}

TEST(Mixed, IsNoReturnOfACurvedRoadOfManyTriangles) {
  // hills of 0.4 m over 80 m: slopes of 1.8 degrees, met under 3 degrees and more
  const Mesh road = terrain(200, 60.0, [](double x, double y) {
    return 0.2 * std::cos(x * 0.0785) * std::cos(y * 0.0785);
  });
  Pose pose = Pose::Identity();
  pose.translation().z() = 2.5;
  const Frame frame = shoot(scene_of({road}), noise_free_preset("OS1-128"), pose);
  EXPECT_GT(count(frame, ReturnSource::surface), 10000);
  EXPECT_EQ(count(frame, ReturnSource::mixed_pixel), 0);
}

TEST(Mixed, IsNoReturnOfAWallOfTwoAdjacentMeshes) {
  testing::PanelScene stage;
  const Vector3d along(0.6, 0.0, 0.8);  // a slope of 53 degrees
  stage.add_panel(Vector3d(0.1, -3.0, 20.0) - 6.0 * along, 6.0 * along, {0.0, 6.0, 0.0});
  stage.add_panel({0.1, -3.0, 20.0}, 6.0 * along, {0.0, 6.0, 0.0});
  const Frame frame = shoot(stage.scene, camera(60, 20, 0.06), Pose::Identity());
  EXPECT_EQ(count(frame, ReturnSource::mixed_pixel), 0);
  EXPECT_EQ(count(frame, ReturnSource::none), 0);
  EXPECT_EQ(count(frame, ReturnSource::surface), 60 * 20);
}

TEST(Mixed, IsNoReturnOfASphereAloneOrACylinderAlone) {
  Scene ball;
  add_model(ball, make_builtin_model("sphere"));
  ball.instances[0].world_from_object.translation() = Vector3d(0.0, 0.0, 12.0);
  Mesh tube;
  constexpr int kSides = 90;
  for (int k = 0; k <= kSides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSides;
    for (const double y : {-5.0, 5.0}) {
      tube.positions_m.push_back(
          Vector3d(0.4 * std::cos(angle), y, 12.0 + 0.4 * std::sin(angle)).cast<float>());
    }
  }
  for (std::uint32_t k = 0; k < kSides; ++k) {
    tube.triangles.push_back({2 * k, 2 * k + 1, 2 * k + 3});
    tube.triangles.push_back({2 * k, 2 * k + 3, 2 * k + 2});
  }
  for (const Scene& scene : {ball, scene_of({tube})}) {
    const Frame frame = shoot(scene, camera(120, 120, 0.2), Pose::Identity());
    EXPECT_GT(count(frame, ReturnSource::surface), 3000);
    EXPECT_EQ(count(frame, ReturnSource::mixed_pixel), 0);
  }
}

/// Whether the sub-rays of each beam of a camera meet x below and above an edge at a distance.
std::vector<bool> straddles(const Sensor& sensor, double edge_m, double distance_m) {
  const Beams beams = make_beams(sensor);
  const std::vector<SubRay> rays = sample_footprint(*sensor.footprint);
  ThreadPool thread_pool(1);
  Beams spread_beams;
  expand_beams(rays, beams, {0, beams.size()}, thread_pool, spread_beams);
  std::vector<bool> result;
  for (std::size_t beam = 0; beam < beams.size(); ++beam) {
    std::size_t below = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const Vector3d& d = spread_beams.directions[beam * rays.size() + k];
      if (d.x() / d.z() * distance_m < edge_m) ++below;
    }
    result.push_back(below > 0 && below < rays.size());
  }
  return result;
}

void expect_mixed_where(const std::vector<bool>& expected, const Frame& frame) {
  ASSERT_GT(std::count(expected.begin(), expected.end(), true), 10);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(frame.status[i], Status::hit);
    EXPECT_EQ(frame.return_source[i],
              expected[i] ? ReturnSource::mixed_pixel : ReturnSource::surface)
        << i;
  }
}

TEST(Mixed, IsEveryReturnThatMergesAnEdgeAndItsBackgroundAndNoOther) {
  for (const double behind_m : {0.06, 0.3, 0.5}) {
    testing::PanelScene stage;
    stage.add_wall(20.0, -50.0, 0.0123);
    stage.add_wall(20.0 + behind_m);
    const Sensor sensor = camera(64, 16, 0.05);
    expect_mixed_where(straddles(sensor, 0.0123, 20.0),
                       shoot(stage.scene, sensor, Pose::Identity()));
  }
}

TEST(Mixed, IsNoneOfTwoSurfacesThatTheReceiverResolves) {
  testing::PanelScene stage;
  stage.add_wall(20.0, -50.0, 0.0123);
  stage.add_wall(22.0);
  const Frame frame = shoot(stage.scene, camera(64, 16, 0.05), Pose::Identity());
  EXPECT_EQ(count(frame, ReturnSource::mixed_pixel), 0);
}

TEST(Mixed, IsTheRimOfAThinWallInFrontOfItsOwnMesh) {
  // one mesh: a front plate that ends at x = 0.0123, and a back plate 0.2 m behind it
  Mesh mesh;
  for (const auto& [end, z] : {std::pair{0.0123F, 20.0F}, std::pair{5.0F, 20.2F}}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
    for (const auto& [x, y] : {std::pair{-5.0F, -5.0F}, {end, -5.0F}, {end, 5.0F}, {-5.0F, 5.0F}}) {
      mesh.positions_m.emplace_back(x, y, z);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  const Sensor sensor = camera(64, 16, 0.05);
  expect_mixed_where(straddles(sensor, 0.0123, 20.0),
                     shoot(scene_of({mesh}), sensor, Pose::Identity()));
}

TEST(Mixed, IsTheNoseOfAStairFromAboveAndNoneOfStairsFromTheFront) {
  // one tread ends at x = 0.0123; the next one is 0.17 m lower, or the riser is seen
  const Sensor sensor = camera(64, 16, 0.05);
  testing::PanelScene above;
  above.add_panel({-3.0, -3.0, 5.0}, {3.0123, 0.0, 0.0}, {0.0, 6.0, 0.0});
  above.add_panel({0.0123, -3.0, 5.17}, {3.0, 0.0, 0.0}, {0.0, 6.0, 0.0});
  expect_mixed_where(straddles(sensor, 0.0123, 5.0), shoot(above.scene, sensor, Pose::Identity()));

  testing::PanelScene front;  // looking down 45 degrees at five steps of 0.2 m
  const Vector3d tread(-0.1414213562, 0.0, 0.1414213562);
  const Vector3d riser(0.1414213562, 0.0, 0.1414213562);
  for (int step = 0; step < 5; ++step) {
    const Vector3d corner = Vector3d(0.0, -3.0, 5.0) + (step - 2.0) * (riser - tread);
    front.add_panel(corner, riser, {0.0, 6.0, 0.0});
    front.add_panel(corner, tread, {0.0, 6.0, 0.0});
  }
  const Frame frame = shoot(front.scene, sensor, Pose::Identity());
  EXPECT_EQ(count(frame, ReturnSource::surface), 64 * 16);
}

}  // namespace
}  // namespace glidar
