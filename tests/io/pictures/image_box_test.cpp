// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Boxes of meshes in images. Expected pixels are projected by hand.
#include <glidar/io/pictures/point_image.hpp>

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace glidar {
namespace {

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
