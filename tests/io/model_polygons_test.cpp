// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Polygons with more than four corners become triangles, the same with all versions of Assimp.
#include <glidar/io/model/import_process.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <vector>

namespace glidar {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::load;
using ::testing::Not;
using testing::TestFolder;
using ::testing::ThrowsMessage;

/// A model of one polygon in the plane x + y + 2 z = 0 whose corners are above the given ones.
Model polygon(const std::vector<Eigen::Vector2d>& corners) {
  std::ostringstream obj;
  obj.precision(17);
  for (const Eigen::Vector2d& c : corners) {
    obj << "v " << c.x() << ' ' << c.y() << ' ' << -(c.x() + c.y()) / 2.0 << '\n';
  }
  obj << 'f';
  for (std::size_t i = 1; i <= corners.size(); ++i) obj << ' ' << i;
  const TestFolder temp;
  return load(temp.write("a.obj", obj.str() + "\n"));
}

/// The area in the plane of the given corners; triangles that face down count negative.
double area(const Model& model) {
  double sum = 0.0;
  for (const auto& t : model.mesh.triangles) {
    const auto corner = [&](int i) -> Eigen::Vector3d {
      return model.mesh.positions_m.at(t[static_cast<std::size_t>(i)]).cast<double>();
    };
    sum += (corner(1) - corner(0)).cross(corner(2) - corner(0)).z() / 2.0;
  }
  return sum;
}

TEST(ModelPolygons, CornersOnAStraightLineLeaveNoHole) {
  const Model model = polygon({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {0, 2}});
  EXPECT_EQ(model.mesh.triangles.size(), 6U);
  EXPECT_EQ(area(model), 6.0);
}

TEST(ModelPolygons, ConcavePolygonsAreCovered) {
  const Model comb = polygon({{0, 0},
                              {7, 0},
                              {7, 3},
                              {6, 3},
                              {6, 1},
                              {4, 1},
                              {4, 3},
                              {3, 3},
                              {3, 1},
                              {1, 1},
                              {1, 3},
                              {0, 3}});
  EXPECT_EQ(comb.mesh.triangles.size(), 10U);
  EXPECT_EQ(area(comb), 13.0);
}

TEST(ModelPolygons, TheSeamToAHoleIsNoSurface) {
  const Model frame =
      polygon({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});
  EXPECT_EQ(frame.mesh.triangles.size(), 8U);
  EXPECT_EQ(area(frame), 12.0);
}

TEST(ModelPolygons, ClockwisePolygonsKeepTheirSide) {
  const Model model = polygon({{0, 2}, {2, 2}, {2, 0}, {1, 1}, {0, 0}});
  EXPECT_EQ(model.mesh.triangles.size(), 3U);
  EXPECT_EQ(area(model), -3.0);
}

/// A star whose spikes alternate between two radii.
std::vector<Eigen::Vector2d> star(std::size_t corners) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 6.0 * static_cast<double>(i) / static_cast<double>(corners);
    const double radius = i % 2 == 0 ? 1.0 : 2.0;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

/// A regular polygon that goes around `turns` times.
std::vector<Eigen::Vector2d> regular(std::size_t corners, double turns) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle =
        turns * 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  return points;
}

TEST(ModelPolygons, ConvexOnesMayHaveAnyNumberOfCorners) {
  EXPECT_EQ(polygon(regular(200'000, 1.0)).mesh.triangles.size(), 199'998U);
}

TEST(ModelPolygons, ThatTurnSeveralTimesAreNotTakenForConvexOnes) {
  EXPECT_LT(polygon(regular(7, 3.0)).mesh.triangles.size(), 5U);  // soon, no ear is left
}

TEST(ModelPolygons, ManyCornersAreSplitOrRefusedInLittleTime) {
  EXPECT_EQ(polygon(star(5000)).mesh.triangles.size(), 4998U);
  EXPECT_THAT([] { polygon(star(30'000)); },
              ThrowsMessage<Error>(HasSubstr("splitting them takes too long")));
}

TEST(ModelPolygons, SelfIntersectionIsReported) {
  EXPECT_THAT(polygon({{0, 2}, {3, 2}, {3, 1}, {2, 0}, {2, 4}}).notes,
              Contains(HasSubstr("polygons that intersect themselves")));
  EXPECT_THAT(polygon({{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}).notes,
              Not(Contains(HasSubstr("polygons that intersect themselves"))));
}

}  // namespace
}  // namespace glidar
