// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/point_image.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

// Boxes of meshes in images. Expected pixels are projected by hand.

namespace glidar {
namespace {

using Points = std::vector<Eigen::Vector3d>;

std::uint32_t point_at(const PointImage& image, std::size_t col, std::size_t row) {
  return image.points.at(row * image.width + col);
}

TEST(TopView, PutsAPointIntoItsPixel) {
  // 100 x 50 pixels of 0.1 m: x = 7.25 m is column 72, y = 1.05 m row 50 - 11
  const TopView view{.left_m = 0.0, .right_m = 10.0, .bottom_m = 0.0, .top_m = 5.0};
  const PointImage image = draw_top_view(Points{{7.25, 1.05, 2.0}}, view, 100, 50);
  EXPECT_EQ(point_at(image, 72, 39), 0U);
  EXPECT_EQ(point_at(image, 72, 30), PointImage::kNoPoint);
  EXPECT_EQ(point_at(image, 60, 39), PointImage::kNoPoint);
  EXPECT_EQ(image.outside, 0U);
}

TEST(TopView, ShowsTheHighestPoint) {
  const TopView view{.left_m = -1.0, .right_m = 1.0, .bottom_m = -1.0, .top_m = 1.0};
  for (const bool is_reversed : {false, true}) {
    Points points = {{0.0, 0.0, 1.0}, {0.0, 0.0, 3.0}, {0.0, 0.0, 2.0}};
    if (is_reversed) std::reverse(points.begin(), points.end());
    const PointImage image = draw_top_view(points, view, 40, 40);
    EXPECT_EQ(point_at(image, 20, 20), 1U);
  }
}

TEST(TopView, CountsWhatIsOutside) {
  const TopView view{.left_m = 0.0, .right_m = 1.0, .bottom_m = 0.0, .top_m = 1.0};
  const Points points = {{0.5, 0.5, 0.0}, {1.5, 0.5, 0.0}, {0.5, -3.0, 0.0}};
  EXPECT_EQ(draw_top_view(points, view, 10, 10).outside, 2U);
}

TEST(TopView, FitsAllPointsAndTheSensorWithEqualScales) {
  const Points points = {{0.0, -5.0, 0.0}, {20.0, 5.0, 0.0}};
  const TopView view = fit_top_view(points, {-10.0, 0.0, 0.0}, 2.0);
  EXPECT_LT(view.left_m, -10.0);
  EXPECT_GT(view.right_m, 20.0);
  EXPECT_NEAR(view.right_m - view.left_m, 2.0 * (view.top_m - view.bottom_m), 1e-9);
}

TEST(TopView, IgnoresOneDistantOutlier) {
  Points points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(0.01 * i, 0.01 * (i % 100), 0.0);
  points[500] = {900.0, 900.0, 0.0};
  const TopView view = fit_top_view(points, Eigen::Vector3d::Zero(), 1.0);
  EXPECT_LT(view.right_m - view.left_m, 15.0);
}

TEST(TopView, HasASizeWithoutPoints) {
  const TopView view = fit_top_view({}, {3.0, 4.0, 0.0}, 1.5);
  EXPECT_GT(view.right_m, view.left_m);
  EXPECT_EQ(draw_top_view({}, view, 30, 20).outside, 0U);
}

TEST(PerspectiveView, ProjectsAsAPinholeOf45Degrees) {
  // looking along +x from the origin: 10 m ahead the upright half view is 10 tan(22.5 degrees) m
  const Perspective view{Eigen::Vector3d::Zero(), {1.0, 0.0, 0.0}, 200, 100};
  const double half_m = 10.0 * std::tan(std::atan(1.0) / 2.0);
  const Eigen::Vector3d middle = view.project({10.0, 0.0, 0.0});
  EXPECT_NEAR(middle.x(), 100.0, 1e-9);
  EXPECT_NEAR(middle.y(), 50.0, 1e-9);
  EXPECT_NEAR(middle.z(), 10.0, 1e-12);
  EXPECT_NEAR(view.project({10.0, 0.0, half_m}).y(), 0.0, 1e-9) << "up is up";
  EXPECT_NEAR(view.project({10.0, half_m, 0.0}).x(), 50.0, 1e-9) << "left is left";
  EXPECT_LT(view.project({-10.0, 0.0, 0.0}).z(), 0.0);
}

TEST(PerspectiveView, MayLookStraightDown) {
  const Perspective view{{0.0, 0.0, 10.0}, Eigen::Vector3d::Zero(), 100, 100};
  EXPECT_TRUE(view.project({1.0, 1.0, 0.0}).allFinite());
  EXPECT_LT(view.project({1.0, 0.0, 0.0}).y(), 50.0) << "ahead is up";
  EXPECT_LT(view.project({0.0, 1.0, 0.0}).x(), 50.0) << "left is left";
}

TEST(PerspectiveView, ShowsTheNearestPoint) {
  const Perspective view{Eigen::Vector3d::Zero(), {1.0, 0.0, 0.0}, 50, 50};
  const PointImage image =
      draw_perspective(Points{{9.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {-5.0, 0.0, 0.0}}, view);
  EXPECT_EQ(point_at(image, 25, 25), 1U);
  EXPECT_EQ(image.outside, 1U) << "one is behind the camera";
}

TEST(PerspectiveView, FitsABoxOfPoints) {
  Points points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back(i % 2 == 0 ? -4.0 : 4.0, i / 2 % 2 == 0 ? -3.0 : 3.0, i < 4 ? 0.0 : 2.0);
  const Perspective view = fit_perspective(points, 400, 300);
  EXPECT_EQ(draw_perspective(points, view).outside, 0U);
  EXPECT_GT(view.eye_m.z(), 2.0) << "from above";
}

TEST(PerspectiveView, HasADistanceForOnePointOrNone) {
  for (const Points& points : {Points{}, Points{{1.0, 2.0, 3.0}}}) {
    const Perspective view = fit_perspective(points, 400, 300);
    EXPECT_GT((view.target_m - view.eye_m).norm(), 0.0);
    EXPECT_EQ(draw_perspective(points, view).outside, 0U);
  }
}

TEST(EdgeShading, DarkensOnlyPixelsBehindAnEdge) {
  PointImage image{.width = 8, .height = 1, .points = {}, .depths = {}};
  image.points.assign(8, 0);
  image.depths = {2.0, 2.0, 2.0, 2.0, 4.0, 4.0, 4.0, 4.0};
  const std::vector<double> shades = shade_edges(image);
  EXPECT_EQ(shades[1], 1.0);
  EXPECT_EQ(shades[3], 1.0) << "the near side keeps its colour";
  EXPECT_LT(shades[4], 0.5);
  EXPECT_EQ(shades[6], 1.0);
}

constexpr RectifiedCamera kCamera = {100.0, 50.0, 99.5, 39.5, 200.0, 80.0};

Mesh triangle(const std::vector<Eigen::Vector3f>& corners) {
  Mesh mesh;
  mesh.positions_m = corners;
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

std::optional<ImageBox> box_of(const Mesh& mesh) {
  return image_box({mesh, Pose::Identity()}, kCamera);
}

void expect_box(const std::optional<ImageBox>& box, const Eigen::Vector4d& pixels) {
  ASSERT_TRUE(box.has_value());
  Eigen::Vector4d found;
  found << box->inside.min(), box->inside.max();
  EXPECT_LT((found - pixels).norm(), 1e-9) << found.transpose();
}

TEST(ImageBox, ContainsTheCornersOfATriangleInTheImage) {
  const auto box = box_of(triangle({{-1, -1, 4}, {2, 0, 4}, {0, 1, 5}}));
  expect_box(box, {74.5, 27.0, 149.5, 49.5});
  EXPECT_EQ(box->truncated, 0.0);
}

TEST(ImageBox, ClipsATriangleThatLeavesTheImage) {
  // pixels (99.5, 39.5), (299.5, 39.5) and (299.5, 139.5): on its long side v rises by half of u,
  // so that it leaves the image at its lower edge, v = 79, at u = 178.5
  const auto corner = box_of(triangle({{0, 0, 1}, {2, 0, 1}, {2, 2, 1}}));
  expect_box(corner, {99.5, 39.5, 199.0, 79.0});
  EXPECT_NEAR(corner->truncated, 1.0 - 99.5 * 39.5 / (200.0 * 100.0), 1e-12);
  // pixels (-100.5, 39.5), (99.5, 139.5) and (-100.5, 139.5): in the image are (0, 89.75) and what
  // is below it, but nothing of it above v = 79
  EXPECT_FALSE(box_of(triangle({{-2, 0, 1}, {0, 2, 1}, {-2, 2, 1}})).has_value());
}

TEST(ImageBox, ClipsAFloorThatExtendsBehindTheCamera) {
  // 1 m below, from 10 m behind to a point 5 m ahead, at v = 49.5; the lower edge of the image,
  // v = 79, cuts it at z = 50 / 39.5 m
  const auto box = box_of(triangle({{-3, 1, -10}, {3, 1, -10}, {0, 1, 5}}));
  ASSERT_TRUE(box.has_value());
  EXPECT_NEAR(box->inside.min().y(), 49.5, 1e-9);
  EXPECT_NEAR(box->inside.max().y(), 79.0, 1e-9);
  const double z = 50.0 / 39.5;
  const double half = 100.0 * 3.0 * (5.0 - z) / 15.0 / z;
  EXPECT_NEAR(box->inside.min().x(), 99.5 - half, 1e-9);
  EXPECT_NEAR(box->inside.max().x(), 99.5 + half, 1e-9);
  EXPECT_GT(box->truncated, 0.999);
  EXPECT_LE(box->truncated, 1.0);
}

TEST(ImageBox, MeshesBehindOrBesideTheViewHaveNoBox) {
  EXPECT_FALSE(box_of(triangle({{0, 0, -1}, {1, 0, -1}, {0, 1, -1}})).has_value());
  EXPECT_FALSE(box_of(triangle({{9, 0, 1}, {9, 1, 1}, {8, 0, 1}})).has_value());
  EXPECT_FALSE(box_of(Mesh{}).has_value());
}

TEST(ImageBox, AMeshAroundTheCameraFillsTheWholeImage) {
  expect_box(box_of(triangle({{-99, -99, 2}, {99, -99, 2}, {0, 99, 2}})), {0.0, 0.0, 199.0, 79.0});
}

TEST(ImageBox, ScaleAndPoseOfTheInstanceAreApplied) {
  const Mesh mesh = triangle({{-1, -1, 0}, {2, 0, 0}, {0, 1, 0}});
  Pose camera_from_object = Pose::Identity();
  camera_from_object.translation() = Eigen::Vector3d(0.0, 0.0, 4.0);
  expect_box(image_box({mesh, camera_from_object, 0.5}, kCamera), {87.0, 33.25, 124.5, 45.75});
}

}  // namespace

}  // namespace glidar
