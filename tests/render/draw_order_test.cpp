// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/draw_order.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace glidar {
namespace {

Mesh torus() {
  return make_builtin_model("torus").mesh;
}

/// Processed vertices per triangle on a device with a cache of the last 32.
double corners_per_triangle(const std::vector<Triangle>& triangles) {
  constexpr std::size_t kRemembered = 32;
  std::vector<std::uint32_t> last;
  std::size_t worked_out = 0;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t corner : triangle) {
      const auto from =
          last.end() - static_cast<std::ptrdiff_t>(std::min(kRemembered, last.size()));
      if (std::find(from, last.end(), corner) != last.end()) continue;
      last.push_back(corner);
      ++worked_out;
    }
  }
  return static_cast<double>(worked_out) / static_cast<double>(triangles.size());
}

/// The k-th triangle in a random order.
Mesh scattered(const Mesh& mesh) {
  Mesh result = mesh;
  const std::size_t n = mesh.triangles.size();
  for (std::size_t k = 0; k < n; ++k) result.triangles[k] = mesh.triangles[k * 7919 % n];
  return result;
}

TEST(DrawOrder, DrawsEveryTriangleOnceWithItsOwnCorners) {
  const Mesh mesh = torus();
  const DrawOrder order = draw_order(mesh, {});
  ASSERT_EQ(order.drawn.size(), mesh.triangles.size());
  std::vector<std::uint32_t> sorted = order.drawn;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
  for (std::size_t place = 0; place < order.drawn.size(); ++place) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(order.vertices[order.triangles[place][k]], mesh.triangles[order.drawn[place]][k]);
    }
  }
  const std::vector<Eigen::Vector3f> moved = in_order(order, mesh.positions_m);
  EXPECT_EQ(moved[order.triangles[5][1]], mesh.positions_m[mesh.triangles[order.drawn[5]][1]]);
  EXPECT_TRUE(in_order(order, std::vector<float>{}).empty());
}

TEST(DrawOrder, KeepsNeighbouringTrianglesTogether) {
  const Mesh mesh = scattered(torus());
  EXPECT_GT(corners_per_triangle(mesh.triangles), 2.0);
  EXPECT_LT(corners_per_triangle(draw_order(mesh, {}).triangles), 1.1);
}

TEST(DrawOrder, DrawsTheTrianglesOfAKindTogether) {
  const Mesh mesh = torus();
  std::vector<std::uint32_t> kinds;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) kinds.push_back(i % 3 == 0 ? 7 : 2);
  const DrawOrder order = draw_order(mesh, kinds);
  ASSERT_EQ(order.ranges.size(), 2U);
  EXPECT_EQ(order.ranges[0].kind, 2U);
  EXPECT_EQ(order.ranges[1].kind, 7U);
  EXPECT_EQ(order.ranges[1].first, order.ranges[0].count);
  EXPECT_EQ(order.ranges[0].count + order.ranges[1].count, mesh.triangles.size());
  for (const DrawRange& range : order.ranges) {
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      EXPECT_EQ(kinds[order.drawn[i]], range.kind);
    }
  }
}

TEST(DrawOrder, TrianglesAtOnePositionKeepTheirOrder) {
  Mesh mesh;
  mesh.positions_m = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};
  EXPECT_EQ(draw_order(mesh, {}).drawn, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(DrawOrder, AcceptsMeshesWithoutSizeOrTriangles) {
  EXPECT_TRUE(draw_order({}, {}).ranges.empty());
  Mesh point;
  point.positions_m.assign(3, Eigen::Vector3f(5.0F, 5.0F, 5.0F));
  point.triangles = {{0, 1, 2}};
  EXPECT_EQ(draw_order(point, {}).drawn.size(), 1U);
}

TEST(DrawOrder, AcceptsTheLargestAndSmallestCoordinates) {
  Mesh small;
  small.positions_m = {{0.0F, 0.0F, 0.0F}, {1e-42F, 0.0F, 0.0F}, {0.0F, 1e-42F, 0.0F}};
  small.triangles = {{0, 1, 2}};
  EXPECT_EQ(draw_order(small, {}).drawn.size(), 1U);
  Mesh mesh;
  mesh.positions_m = {{-1e15F, 0.0F, 0.0F}, {1e15F, 1e15F, 0.0F}, {0.0F, -1e15F, 1e15F}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(draw_order(mesh, {}).drawn.size(), 1U);
}

}  // namespace
}  // namespace glidar
