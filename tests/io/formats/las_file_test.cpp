// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_file.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace glidar {
namespace {

using ::testing::HasSubstr;

/// Points along a diagonal of a cube with this corner and side, m.
std::vector<double> diagonal(double corner_m, double side_m) {
  std::vector<double> xyz;
  constexpr int kPoints = 97;
  for (int i = 0; i <= kPoints; ++i) {
    for (const double sign : {1.0, -1.0, 0.5})
      xyz.push_back(sign * corner_m + side_m * (i / static_cast<double>(kPoints)));
  }
  return xyz;
}

/// The maximum distance between the points and what the grid stores, per axis.
double max_error_m(const LasGrid& grid, const std::vector<double>& xyz) {
  double error_m = 0.0;
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    const auto count = static_cast<std::int32_t>(grid.counts[i % 3][i / 3]);
    error_m = std::max(error_m, std::abs(count * grid.scale_m + grid.offset_m[axis] - xyz[i]));
  }
  return error_m;
}

TEST(LasGrid, OfScenesFrom100MetresOnHasStepsOfATenthOfAMillimetre) {
  for (const double side_m : {101.0, 5000.0, 150'000.0}) {
    const std::vector<double> xyz = diagonal(3.0, side_m);
    const LasGrid grid = make_las_grid(xyz);
    EXPECT_EQ(grid.scale_m, 1e-4) << side_m;
    EXPECT_LE(max_error_m(grid, xyz), 0.5e-4 + 1e-10) << side_m;
    EXPECT_EQ(las_rounding_warning(xyz), "");
  }
}

TEST(LasGrid, OfSmallScenesResolvesAMillionthOfThem) {
  for (const double side_m : {50.0, 1.0, 0.02, 3e-4, 1e-6, 1e-12}) {
    for (const double corner_m : {0.0, 2.5 * side_m, 20.0}) {
      if (side_m < 1e-9 && corner_m == 20.0) continue;  // beyond double precision
      const std::vector<double> xyz = diagonal(corner_m, side_m);
      const LasGrid grid = make_las_grid(xyz);
      const double spacing_m = corner_m * std::numeric_limits<double>::epsilon();
      EXPECT_LE(grid.scale_m, 1.01e-6 * side_m) << side_m;
      EXPECT_LE(max_error_m(grid, xyz), 0.51 * grid.scale_m + 4.0 * spacing_m) << side_m;
    }
  }
}

TEST(LasGrid, OfATinyObjectFarFromTheSensorIsRelativeToAnOffset) {
  std::vector<double> xyz;
  for (int i = 0; i <= 10; ++i) xyz.insert(xyz.end(), {20.0 + i * 1.5e-4, -7.0 + i * 1.5e-4, 0.25});
  const LasGrid grid = make_las_grid(xyz);
  EXPECT_EQ(grid.scale_m, 1e-9);
  EXPECT_LE(max_error_m(grid, xyz), 1e-9);
  EXPECT_NEAR(grid.offset_m.x(), 20.0, 0.06);
}

TEST(LasGrid, OfOnePointResolvesItsDistance) {
  const std::vector<double> xyz = {1.23456789e-5, 0.0, 0.0};
  const LasGrid grid = make_las_grid(xyz);
  EXPECT_LE(max_error_m(grid, xyz), 1e-11);
  EXPECT_EQ(make_las_grid({0.0, 0.0, 0.0}).scale_m, 1e-4);
  EXPECT_EQ(make_las_grid({}).scale_m, 1e-4);
}

TEST(LasGrid, OfHugeScenesFits32BitsAndWarns) {
  for (const double side_m : {1e6, 1e9, 1e15}) {
    const std::vector<double> xyz = diagonal(0.0, side_m);
    const LasGrid grid = make_las_grid(xyz);
    EXPECT_GT(grid.scale_m, 1e-4);
    EXPECT_LE(max_error_m(grid, xyz), 0.51 * grid.scale_m);
    EXPECT_LT(grid.scale_m, side_m * 1e-8);
    EXPECT_THAT(las_rounding_warning(xyz), HasSubstr("write .npz, .csv or .ply"));
  }
  EXPECT_THAT(las_rounding_warning(diagonal(0.0, 1e6)),
              HasSubstr("in steps of 0.001 m, which moves its points by up to 0.0005 m"));
}

TEST(LasGrid, HasTheBoundsOfTheStoredPoints) {
  const LasGrid grid = make_las_grid({1.00004, -2.0, 5.0, 301.00006, 7.0, 5.0});
  EXPECT_DOUBLE_EQ(grid.min_m.x(), 1.0);
  EXPECT_DOUBLE_EQ(grid.max_m.x(), 301.0001);
  EXPECT_DOUBLE_EQ(grid.min_m.y(), -2.0);
}

}  // namespace

namespace {

using ::testing::ElementsAre;

TEST(LasStandardClass, IsThatOfTheSpecification) {
  EXPECT_EQ(las_standard_class("unclassified"), 1);
  EXPECT_EQ(las_standard_class("ground"), 2);
  EXPECT_EQ(las_standard_class("low_vegetation"), 3);
  EXPECT_EQ(las_standard_class("medium_vegetation"), 4);
  EXPECT_EQ(las_standard_class("high_vegetation"), 5);
  EXPECT_EQ(las_standard_class("building"), 6);
  EXPECT_EQ(las_standard_class("low_noise"), 7);
  EXPECT_EQ(las_standard_class("water"), 9);
  EXPECT_EQ(las_standard_class("rail"), 10);
  EXPECT_EQ(las_standard_class("road_surface"), 11);
  EXPECT_EQ(las_standard_class("wire_guard"), 13);
  EXPECT_EQ(las_standard_class("wire_conductor"), 14);
  EXPECT_EQ(las_standard_class("transmission_tower"), 15);
  EXPECT_EQ(las_standard_class("wire_structure_connector"), 16);
  EXPECT_EQ(las_standard_class("bridge_deck"), 17);
  EXPECT_EQ(las_standard_class("high_noise"), 18);
  EXPECT_EQ(las_standard_class("overhead_structure"), 19);
  EXPECT_EQ(las_standard_class("ignored_ground"), 20);
  EXPECT_EQ(las_standard_class("snow"), 21);
}

TEST(LasStandardClass, IgnoresCaseAndSeparatorsOfWords) {
  for (const char* name : {"Road Surface", "road-surface", "ROAD_SURFACE"})
    EXPECT_EQ(las_standard_class(name), 11) << name;
  for (const char* name : {"", "car", "roads"}) EXPECT_EQ(las_standard_class(name), 0) << name;
}

TEST(LasClassCodes, OfOtherClassesAreUserDefinable) {
  const std::vector<std::string> names = {"unlabelled", "car", "tree", "person"};
  EXPECT_THAT(las_class_codes(names), ElementsAre(1, 64, 5, 66));
}

TEST(LasClassCodes, BeyondTheUserDefinableOnesAreUnclassified) {
  std::vector<std::string> names(200, "thing");
  names[199] = "water";
  const std::vector<std::uint8_t> codes = las_class_codes(names);
  EXPECT_EQ(codes[0], 1);
  EXPECT_EQ(codes[192], 255);
  EXPECT_EQ(codes[193], 1);
  EXPECT_EQ(codes[199], 9);
}

}  // namespace
}  // namespace glidar
