// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/direction_grid.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

namespace glidar {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// Random directions, those along the edges and corners of the cube, and one that is NaN.
std::vector<Eigen::Vector3d> mixed_directions(std::mt19937& random) {
  std::vector<Eigen::Vector3d> directions(5000);
  for (Eigen::Vector3d& direction : directions) direction = random_direction(random);
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Eigen::Vector3d corner(x, y, z);
        if (corner.norm() > 0.0) directions.push_back(corner.normalized());
      }
    }
  }
  directions.emplace_back(kNan, kNan, kNan);
  return directions;
}

TEST(DirectionGrid, FindsEveryDirectionOfAConeOnce) {
  std::mt19937 random(1);
  const std::vector<Eigen::Vector3d> directions = mixed_directions(random);
  DirectionGrid grid;
  grid.build(directions);
  std::vector<std::uint32_t> found;
  for (const double angle : {0.0, 1e-9, 0.01, 0.3, 1.6, 3.0}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Eigen::Vector3d axis = directions[random() % (directions.size() - 1)];
      grid.find(axis, angle, found);
      const std::set<std::uint32_t> unique(found.begin(), found.end());
      EXPECT_EQ(unique.size(), found.size());
      for (std::uint32_t i = 0; i + 1 < directions.size(); ++i) {
        const double between =
            std::atan2(axis.cross(directions[i]).norm(), axis.dot(directions[i]));
        EXPECT_TRUE(between > angle || unique.count(i) == 1) << i << " at " << angle;
      }
    }
  }
}

TEST(DirectionGrid, FindsAllDirectionsThatAreNumbersInAWholeTurn) {
  std::mt19937 random(2);
  const std::vector<Eigen::Vector3d> directions = mixed_directions(random);
  DirectionGrid grid;
  grid.build(directions);
  std::vector<std::uint32_t> found;
  grid.find({kNan, 0.0, 0.0}, std::numbers::pi, found);
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), directions.size() - 1);
  EXPECT_EQ(found.back(), directions.size() - 2);
}

TEST(DirectionGrid, FindsFewDirectionsOfASmallCone) {
  std::mt19937 random(3);
  const std::vector<Eigen::Vector3d> directions = mixed_directions(random);
  DirectionGrid grid;
  grid.build(directions);
  std::vector<std::uint32_t> found;
  grid.find(Eigen::Vector3d::UnitX(), 0.01, found);
  EXPECT_LT(found.size(), directions.size() / 50);
  grid.build({});
  grid.find(Eigen::Vector3d::UnitX(), 1.0, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace glidar
