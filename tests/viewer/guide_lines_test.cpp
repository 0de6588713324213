// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>

#include <glidar/sensor/optics/pinhole.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

constexpr float kSingle = 1e-5F;

Beams camera_beams() {
  return make_beams(pinhole_from_fov(8, 6, 0.5));
}

TEST(GridSpacing, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(grid_spacing_m(10.0), 1.0);
  EXPECT_DOUBLE_EQ(grid_spacing_m(19.0), 1.0);
  EXPECT_DOUBLE_EQ(grid_spacing_m(20.0), 2.0);
  EXPECT_DOUBLE_EQ(grid_spacing_m(70.0), 5.0);
  EXPECT_NEAR(grid_spacing_m(0.03), 0.002, 1e-15);
  EXPECT_DOUBLE_EQ(grid_spacing_m(3e6), 2e5);
}

TEST(AddGrid, IsHorizontalAtMultiplesOfItsSpacing) {
  Lines lines;
  add_grid({0.4, -0.3, 2.0}, 3.0, 1.0, lines);
  ASSERT_EQ(lines.size(), 2U * 2U * 7U);
  for (const ColouredVertex& vertex : lines) {
    EXPECT_FLOAT_EQ(vertex.position_m.z(), 2.0F);
    EXPECT_FLOAT_EQ(vertex.position_m.x(), std::round(vertex.position_m.x()));
    EXPECT_LE(vertex.position_m.head<2>().cwiseAbs().maxCoeff(), 3.0F);
  }
}

TEST(AddAxes, PointAlongTheAxesOfThePose) {
  Lines lines;
  Pose pose = optical_from_body();
  pose.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  add_axes(pose, 2.0, lines);
  ASSERT_EQ(lines.size(), 6U);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(2 * axis);
    EXPECT_TRUE(lines[at].position_m.isApprox(Eigen::Vector3f(1.0F, 2.0F, 3.0F)));
    const Eigen::Vector3d tip = pose.translation() + 2.0 * pose.linear().col(axis);
    EXPECT_TRUE(lines[at + 1].position_m.isApprox(tip.cast<float>(), kSingle));
  }
}

TEST(AddFrustum, OutlinesACamerasViewFromTheSensor) {
  const Beams beams = camera_beams();
  Lines lines;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(5.0, 0.0, 0.0);
  add_frustum(beams, pose, 2.0, lines);
  ASSERT_FALSE(lines.empty());
  std::size_t at_sensor = 0;
  for (const ColouredVertex& vertex : lines) {
    const float range = (vertex.position_m - Eigen::Vector3f(5.0F, 0.0F, 0.0F)).norm();
    EXPECT_TRUE(range < kSingle || std::abs(range - 2.0F) < kSingle) << range;
    at_sensor += range < kSingle ? 1 : 0;
  }
  EXPECT_GE(at_sensor, 4U);
  const Eigen::Vector3f corner =
      (pose * Eigen::Vector3d(2.0 * beams.directions.front())).cast<float>();
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const ColouredVertex& vertex) {
    return vertex.position_m.isApprox(corner, kSingle);
  }));
}

TEST(AddFrustum, SkipsPixelsWithoutABeam) {
  Beams beams = camera_beams();
  std::fill(beams.directions.begin(), beams.directions.end(), Eigen::Vector3d::Constant(NAN));
  Lines lines;
  add_frustum(beams, Pose::Identity(), 1.0, lines);
  EXPECT_TRUE(lines.empty());
  add_frustum(Beams{}, Pose::Identity(), 1.0, lines);
  EXPECT_TRUE(lines.empty());
}

TEST(AddBoxes, DrawsTheTwelveEdgesOfEachBox) {
  std::vector<Eigen::Vector3d> corners_m;
  for (int box = 0; box < 2; ++box) {
    for (int i = 0; i < 8; ++i) corners_m.emplace_back(i & 1, (i >> 1) & 1, 10 * box + (i >> 2));
  }
  Lines lines;
  add_boxes(corners_m, lines);
  ASSERT_EQ(lines.size(), 2U * 2U * 12U);
  for (std::size_t k = 0; k < lines.size(); k += 2) {
    EXPECT_EQ((lines[k].position_m - lines[k + 1].position_m).norm(), 1.0F) << "no diagonals";
  }
}

}  // namespace
}  // namespace glidar::app
