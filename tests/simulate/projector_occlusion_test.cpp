// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <simulate/panels.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

using testing::PanelScene;

constexpr double kFocal_px = 575.8;
constexpr double kBaseline_m = 0.075;

/// A row of a Kinect-like camera before a front panel that ends at x = 0 and a wall behind it.
struct Stage {
  PanelScene panels;
  Sensor sensor;

  explicit Stage(double baseline_m = kBaseline_m) {
    Pinhole pinhole;
    pinhole.intrinsics.width = 640;
    pinhole.intrinsics.height = 1;
    pinhole.intrinsics.fx = kFocal_px;
    pinhole.intrinsics.fy = kFocal_px;
    pinhole.intrinsics.cx = 320.0;
    pinhole.intrinsics.cy = 0.5;
    sensor.optics = pinhole;
    sensor.projector_origin_m = Eigen::Vector3d(baseline_m, 0.0, 0.0);
  }
  [[nodiscard]] Frame shoot() const {
    const auto renderer = make_renderer(panels.scene, {.threads = 2});
    const Beams beams = make_beams(sensor);
    const Motion motion = static_motion(panels.scene, Pose::Identity());
    Frame frame;
    testing::simulate({panels.scene, sensor, beams, motion, *renderer}, {}, frame);
    return frame;
  }
};

std::size_t count(const Frame& frame, Status status) {
  return static_cast<std::size_t>(std::count(frame.status.begin(), frame.status.end(), status));
}

// The shadow is f b (1/z1 - 1/z2) pixels wide.
TEST(ProjectorOcclusion, HasTheWidthOfTheDisparityStep) {
  for (const auto& [front_m, back_m] : {std::pair{0.8, 1.6}, std::pair{1.0, 3.0}}) {
    Stage stage;
    stage.panels.add_wall(front_m, 0.0, 5.0);
    stage.panels.add_wall(back_m);
    const double expected_px = kFocal_px * kBaseline_m * (1.0 / front_m - 1.0 / back_m);
    const Frame frame = stage.shoot();
    EXPECT_NEAR(static_cast<double>(count(frame, Status::occluded)), expected_px, 1.0);
    for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
      if (frame.status[i] != Status::occluded) continue;
      EXPECT_TRUE(std::isnan(frame.range_m[i]));
      EXPECT_EQ(frame.ground_truth.instance[i], 1U) << "the ground truth is the wall";
      EXPECT_LT(i, 320U) << "on the side away from the projector";
    }
  }
}

TEST(ProjectorOcclusion, IsOnTheOppositeSideOfTheProjector) {
  Stage stage(-kBaseline_m);
  stage.panels.add_wall(1.0, -5.0, 0.0);
  stage.panels.add_wall(2.0);
  const Frame frame = stage.shoot();
  EXPECT_NEAR(static_cast<double>(count(frame, Status::occluded)), kFocal_px * kBaseline_m * 0.5,
              1.0);
}

TEST(ProjectorOcclusion, IsNoneOnASingleWallAndWithoutAProjector) {
  Stage stage;
  stage.panels.add_wall(1.0);
  EXPECT_EQ(count(stage.shoot(), Status::hit), 640U);
  stage.panels.add_wall(0.7, 0.0, 5.0);
  stage.sensor.projector_origin_m.reset();
  EXPECT_EQ(count(stage.shoot(), Status::occluded), 0U);
}

TEST(ProjectorOcclusion, IncludesSurfacesWhoseOtherSideIsLit) {
  // a panel almost along the view, seen from the left, with the projector to its right
  Stage stage(0.2);
  stage.panels.add_panel({0.05, -1.0, 0.5}, {0.05, 0.0, 1.0}, {0.0, 2.0, 0.0});
  const Frame frame = stage.shoot();
  EXPECT_EQ(count(frame, Status::hit), 0U);
  EXPECT_GT(count(frame, Status::occluded), 0U);
}

/// Swaps a panel's sides.
void turn_over(Mesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

TEST(ProjectorOcclusion, IsNotCausedByCulledBackFaces) {
  Stage stage;
  stage.panels.add_wall(1.0, 0.0, 5.0);
  stage.panels.add_wall(2.0);
  for (Mesh& mesh : stage.panels.scene.meshes) turn_over(mesh);
  stage.sensor.cull_back_faces = true;
  EXPECT_GT(count(stage.shoot(), Status::occluded), 0U);
  turn_over(stage.panels.scene.meshes[0]);
  EXPECT_EQ(count(stage.shoot(), Status::hit), 640U);
}

}  // namespace
}  // namespace glidar
