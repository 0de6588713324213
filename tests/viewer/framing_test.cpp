// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glidar::app {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

constexpr double kRounding = 1e-12;

/// Corners of a cube.
Corners cube(const Eigen::Vector3d& middle_m, double half_m) {
  Corners corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(middle_m + half_m * Eigen::Vector3d((i & 1) != 0 ? 1.0 : -1.0,
                                                             (i & 2) != 0 ? 1.0 : -1.0,
                                                             (i & 4) != 0 ? 1.0 : -1.0));
  }
  return corners;
}

/// A camera whose image extends 0.5 to the sides and 0.25 up and down, at depth 1.
FieldOfView wide_picture() {
  return {.axes = {.ahead = Eigen::Vector3d::UnitZ(),
                   .left = -Eigen::Vector3d::UnitX(),
                   .up = -Eigen::Vector3d::UnitY()},
          .left = 0.5,
          .right = 0.5,
          .up = 0.25,
          .down = 0.25};
}

/// Beams of a camera through these points of the plane at depth 1.
Beams camera(const std::vector<Eigen::Vector2d>& places) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(places.size());
  for (const Eigen::Vector2d& at : places) {
    beams.directions.push_back(direction_through(at.x(), at.y()));
  }
  return beams;
}

TEST(Framing, TheSphereContainsAllCorners) {
  const Sphere sphere = sphere_around(cube({1.0, 2.0, 3.0}, 2.0));
  EXPECT_TRUE(sphere.middle_m.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), kRounding));
  EXPECT_NEAR(sphere.radius_m, 2.0 * std::sqrt(3.0), kRounding);
  EXPECT_EQ(sphere_around({}).radius_m, 0.0);
}

/// Whether a point, relative to the anchor, is in the view of the eye.
bool is_seen(const Orbit& orbit, const Eigen::Vector3d& point_m, double aspect) {
  const Eigen::Vector4f clip =
      clip_from_anchor(orbit, aspect) * point_m.cast<float>().homogeneous();
  return clip.w() > 0.0F && std::abs(clip.x()) <= clip.w() && std::abs(clip.y()) <= clip.w();
}

TEST(Framing, AFramedSphereFillsMostOfTheViewAndIsNotCutOff) {
  for (const double aspect : {0.4, 0.8, 1.0, 3.0}) {
    for (const double radius_m : {1e-3, 1.0, 1e6}) {
      Orbit orbit{.yaw_rad = 0.7, .pitch_rad = 0.3};
      const Sphere sphere{radius_m * Eigen::Vector3d(5.0, -3.0, 2.0), radius_m};
      frame_sphere(orbit, sphere, aspect);
      EXPECT_TRUE(orbit.pivot_m.isApprox(sphere.middle_m, kRounding));
      EXPECT_EQ(orbit.yaw_rad, 0.7) << "the direction of view stays";
      const Eigen::Matrix3d axes = anchor_from_eye(orbit).linear();
      const Eigen::Vector3d up = axes.col(1);
      const Eigen::Vector3d across = axes.col(0);
      for (const Eigen::Vector3d& way :
           {up, across, Eigen::Vector3d(-up), Eigen::Vector3d(-across)}) {
        EXPECT_TRUE(is_seen(orbit, sphere.middle_m + radius_m * way, aspect));
      }
      const Eigen::Vector3d& narrow = aspect < 1.0 ? across : up;
      EXPECT_FALSE(is_seen(orbit, sphere.middle_m + 1.3 * radius_m * narrow, aspect));
    }
  }
}

TEST(Framing, ZoomsOutOnlyAsFarAsNeeded) {
  Orbit orbit{.distance_m = 1.0};
  const Corners corners = cube(Eigen::Vector3d::Zero(), 3.0);
  zoom_out_to(orbit, corners, 0.8);
  for (const Eigen::Vector3d& corner : corners) EXPECT_TRUE(is_seen(orbit, corner, 0.8));
  const double distance_m = orbit.distance_m;
  zoom_out_to(orbit, corners, 0.8);
  EXPECT_EQ(orbit.distance_m, distance_m);
  zoom(orbit, 1.0);
  zoom_out_to(orbit, corners, 0.8);
  EXPECT_NEAR(orbit.distance_m, distance_m, kRounding * distance_m)
      << "a step nearer cuts a corner";
}

TEST(Framing, TheFirstViewContainsTheObjectsAndTheSensor) {
  for (const double half_m : {0.5, 3.0, 70.0}) {
    const Corners corners = cube(Eigen::Vector3d::Zero(), half_m);
    const Eigen::AlignedBox3d box(corners.front(), corners.back());
    for (const double sensor_m : {0.0, 2.0, 20.0, 100.0}) {
      const Eigen::Vector3d sensor = sensor_m * Eigen::Vector3d(-0.6, 0.8, 0.0);
      const Orbit orbit = view_of_all(box, sensor, 0.8);
      EXPECT_TRUE(is_seen(orbit, sensor, 0.8));
      for (const Eigen::Vector3d& corner : corners) EXPECT_TRUE(is_seen(orbit, corner, 0.8));
    }
  }
  EXPECT_TRUE(is_seen(view_of_all({}, {3.0, 0.0, 0.0}, 0.8), {3.0, 0.0, 0.0}, 0.8)) << "no objects";
}

TEST(Framing, TheFieldOfViewIsThatOfTheOutermostBeams) {
  const auto field = field_of_view(camera({{0.5, 0.25}, {-0.4, -0.2}, {0.0, 0.0}}));
  ASSERT_TRUE(field);
  EXPECT_NEAR(field->right, 0.5, kRounding);
  EXPECT_NEAR(field->left, 0.4, kRounding);
  EXPECT_NEAR(field->down, 0.25, kRounding) << "y of cameras is down";
  EXPECT_NEAR(field->up, 0.2, kRounding);
}

TEST(Framing, PanoramicSensorsAndLinesHaveNoFieldToAim) {
  Beams all_around = camera({{0.5, 0.5}, {-0.5, -0.5}});
  all_around.directions.emplace_back(-Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(field_of_view(all_around));
  EXPECT_FALSE(field_of_view(camera({{0.5, 0.0}, {-0.5, 0.0}}))) << "a line";
  EXPECT_FALSE(field_of_view(camera({{0.0, 0.0}})));
  EXPECT_FALSE(field_of_view(camera({})));
}

TEST(Framing, DistinguishesInsidePartlyAndOutside) {
  const FieldOfView field = wide_picture();
  const Pose pose = Pose::Identity();
  EXPECT_EQ(visibility(field, pose, cube({0.0, 0.0, 10.0}, 1.0)), Visibility::inside);
  EXPECT_EQ(visibility(field, pose, cube({5.0, 0.0, 10.0}, 1.0)), Visibility::partly);
  EXPECT_EQ(visibility(field, pose, cube({8.0, 0.0, 10.0}, 1.0)), Visibility::outside);
  EXPECT_EQ(visibility(field, pose, cube({0.0, 0.0, -10.0}, 1.0)), Visibility::outside) << "behind";
  EXPECT_EQ(visibility(field, pose, cube({0.0, 0.0, -10.0}, 9.0)), Visibility::outside);
  EXPECT_EQ(visibility(field, pose, cube({0.0, 0.0, 0.0}, 1.0)), Visibility::partly) << "around it";
}

TEST(Framing, AimsACameraAtObjectsOutsideItsImage) {
  const FieldOfView field = wide_picture();
  const Corners corners = cube({0.0, 0.0, -10.0}, 0.5);  // behind it, and small enough
  const auto pose = pose_to_show(field, Pose::Identity(), corners);
  ASSERT_TRUE(pose);
  EXPECT_TRUE(is_rigid(*pose));
  EXPECT_TRUE(pose->translation().isZero(0.0)) << "it only turns";
  EXPECT_EQ(visibility(field, *pose, corners), Visibility::inside);
  EXPECT_FALSE(pose_to_show(field, *pose, corners)) << "nothing is left to do";
}

TEST(Framing, MovesACameraBackIfAimingIsNotEnough) {
  const FieldOfView field = wide_picture();
  const Corners corners = cube({6.0, 0.0, 0.0}, 2.0);
  const auto pose = pose_to_show(field, Pose::Identity(), corners);
  ASSERT_TRUE(pose);
  EXPECT_LT(pose->translation().x(), 0.0);
  EXPECT_EQ(visibility(field, *pose, corners), Visibility::inside);
}

TEST(Framing, KeepsACameraThatIsBetweenTheObjects) {
  const FieldOfView field = wide_picture();
  EXPECT_FALSE(pose_to_show(field, Pose::Identity(), cube({0.0, 0.0, 0.0}, 5.0)));
  EXPECT_FALSE(pose_to_show(field, Pose::Identity(), cube({1.0, 0.0, 0.0}, 5.0)));
}

TEST(Framing, RotatesByTheShortestArc) {
  const FieldOfView field = wide_picture();
  const auto pose = aimed_at(field, Pose::Identity(), {3.0, 0.0, 3.0});
  ASSERT_TRUE(pose);
  const Eigen::AngleAxisd turn(pose->linear());
  EXPECT_NEAR(turn.angle(), std::atan(1.0), kRounding);
  EXPECT_TRUE((pose->linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d(1.0, 0.0, 1.0).normalized(), kRounding));
  EXPECT_FALSE(aimed_at(field, Pose::Identity(), Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace glidar::app
