// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>
#include <glidar/math/constants.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glidar::app {
namespace {

constexpr double kRounding = 1e-12;
constexpr float kSingle = 1e-5F;  // rounding of the matrix in single precision

Orbit some_orbit() {
  return {.pivot_m = {1.0, -2.0, 3.0}, .yaw_rad = 0.7, .pitch_rad = 0.3, .distance_m = 5.0};
}

Eigen::Vector2f seen_at(const Orbit& orbit, const Eigen::Vector3d& point_m) {
  const Eigen::Vector4f clip = clip_from_anchor(orbit, 1.0) * point_m.cast<float>().homogeneous();
  return clip.head<2>() / clip.w();
}

TEST(Orbit, LooksAtItsPivotFromItsDistanceWithZUp) {
  const Orbit orbit = some_orbit();
  const Pose eye = anchor_from_eye(orbit);
  EXPECT_NEAR((eye.translation() - orbit.pivot_m).norm(), orbit.distance_m, kRounding);
  EXPECT_TRUE((eye.linear().col(2) * orbit.distance_m)
                  .isApprox(orbit.pivot_m - eye.translation(), kRounding));
  EXPECT_LT(eye.linear().col(1).z(), 0.0) << "y of the image is down";
  EXPECT_NEAR(eye.linear().col(0).z(), 0.0, kRounding) << "the horizon is level";
}

TEST(Orbit, ShowsThePivotInTheCentreAndHigherPointsHigher) {
  const Orbit orbit = some_orbit();
  EXPECT_NEAR(seen_at(orbit, orbit.pivot_m).norm(), 0.0F, kSingle);
  EXPECT_GT(seen_at(orbit, orbit.pivot_m + Eigen::Vector3d::UnitZ()).y(), 0.1F);
}

TEST(Orbit, SeesHalfItsHeightAtTheEdge) {
  const Orbit orbit = {.pitch_rad = 0.0, .distance_m = 2.0};
  const double half_height_m = 2.0 * std::tan(kOrbitFov_rad / 2.0);
  EXPECT_NEAR(seen_at(orbit, {0.0, 0.0, half_height_m}).y(), 1.0F, kSingle);
}

TEST(Pan, KeepsThePivotsPlaneUnderThePointer) {
  Orbit orbit = some_orbit();
  const Eigen::Vector3d before = orbit.pivot_m;
  pan(orbit, {0.25, -0.1});  // heights: right and up
  const Eigen::Vector2f at = seen_at(orbit, before);
  EXPECT_NEAR(at.x(), 2.0F * 0.25F, kSingle);
  EXPECT_NEAR(at.y(), 2.0F * 0.1F, kSingle);
}

TEST(Turn, StopsBeforeThePoles) {
  Orbit orbit;
  turn(orbit, {0.0, 100.0});
  EXPECT_LT(orbit.pitch_rad, 1.5708);
  EXPECT_NO_THROW(anchor_from_eye(orbit));
  turn(orbit, {0.0, -200.0});
  EXPECT_GT(orbit.pitch_rad, -1.5708);
  EXPECT_NO_THROW(anchor_from_eye(orbit));
}

TEST(Zoom, MovesTenPercentCloserPerStepWithinLimits) {
  Orbit orbit = {.distance_m = 10.0};
  zoom(orbit, 1.0);
  EXPECT_NEAR(orbit.distance_m, 9.0, kRounding);
  zoom(orbit, -1.0);
  EXPECT_NEAR(orbit.distance_m, 10.0, kRounding);
  zoom(orbit, 1e6);
  EXPECT_GT(orbit.distance_m, 0.0);
  zoom(orbit, -1e6);
  EXPECT_TRUE(std::isfinite(orbit.distance_m));
}

TEST(PointAt, FindsThePointUnderThePointerClosestToTheEye) {
  const Orbit orbit = {.pitch_rad = 0.0, .distance_m = 10.0};  // the eye at x = 10
  const float nan = kNaNf;
  const std::vector<Eigen::Vector3f> points = {{-2.0F, 0.0F, 0.0F},
                                               {2.0F, 0.0F, 0.0F},
                                               {nan, nan, nan},
                                               {3.0F, 2.0F, 0.0F},
                                               {20.0F, 0.0F, 0.0F}};  // behind the eye
  EXPECT_THAT(point_at(orbit, points, {0.0, 0.0}, 0.01), ::testing::Optional(1U));
  EXPECT_EQ(point_at(orbit, points, {0.0, 0.9}, 0.01), std::nullopt);
  const double y = 2.0 / 7.0 / std::tan(kOrbitFov_rad / 2.0);  // +y is to the right from +x
  EXPECT_THAT(point_at(orbit, points, {y, 0.0}, 0.01), ::testing::Optional(3U));
}

}  // namespace
}  // namespace glidar::app
