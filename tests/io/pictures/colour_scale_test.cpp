// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/math/constants.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace glidar {
namespace {

using ::testing::ElementsAre;

std::vector<double> counted(std::size_t size) {
  std::vector<double> values(size);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

TEST(ColourScale, HasTheExtremesOfEvenValues) {
  const ColourScale scale = make_colour_scale(counted(1001));
  EXPECT_EQ(scale.low, 0.0);
  EXPECT_EQ(scale.high, 1000.0);
  EXPECT_FALSE(scale.clips_low);
  EXPECT_FALSE(scale.clips_high);
}

TEST(ColourScale, IgnoresOneDistantOutlier) {
  std::vector<double> values = counted(1001);
  values[17] = 1e6;
  const ColourScale scale = make_colour_scale(values);
  EXPECT_EQ(scale.low, 0.0);
  EXPECT_EQ(scale.high, 991.0) << "rank 990 of 0 to 1000 without 17: the 99th percentile";
  EXPECT_TRUE(scale.clips_high);
  EXPECT_FALSE(scale.clips_low);
  EXPECT_EQ(scale.fraction(1e6), 1.0);
}

TEST(ColourScale, IgnoresOneNearOutlier) {
  std::vector<double> values = counted(1001);
  values[400] = -5e3;
  const ColourScale scale = make_colour_scale(values);
  EXPECT_EQ(scale.low, 9.0) << "rank 10, below which is the odd one";
  EXPECT_TRUE(scale.clips_low);
  EXPECT_EQ(scale.fraction(-5e3), 0.0);
}

TEST(ColourScale, DoesNotDependOnTheOrder) {
  std::vector<double> values = counted(500);
  values[3] = 9e9;
  const ColourScale scale = make_colour_scale(values);
  std::reverse(values.begin(), values.end());
  const ColourScale reversed = make_colour_scale(values);
  EXPECT_EQ(scale.low, reversed.low);
  EXPECT_EQ(scale.high, reversed.high);
}

TEST(ColourScale, KeepsBothEndsOfFewValues) {
  const std::vector<double> values = {1.0, 100.0};
  const ColourScale scale = make_colour_scale(values);
  EXPECT_EQ(scale.low, 1.0);
  EXPECT_EQ(scale.high, 100.0);
}

TEST(ColourScale, IsAConstantForEqualValues) {
  const std::vector<double> values(300, 2.5);
  const ColourScale scale = make_colour_scale(values);
  EXPECT_TRUE(scale.has_values);
  EXPECT_EQ(scale.low, 2.5);
  EXPECT_EQ(scale.high, 2.5);
  EXPECT_EQ(scale.fraction(2.5), 0.0);
  EXPECT_EQ(scale.fraction(2.6), 1.0);
}

TEST(ColourScale, ClipsOneOutlierOfAConstant) {
  std::vector<double> values(300, 2.5);
  values[0] = 100.0;
  const ColourScale scale = make_colour_scale(values);
  EXPECT_EQ(scale.high, 2.5);
  EXPECT_TRUE(scale.clips_high);
  EXPECT_THAT(scale_ends(scale, "m"), ElementsAre("2.5", "\u2265 2.5 m"));
}

TEST(ColourScale, IsEmptyWithoutValues) {
  EXPECT_FALSE(make_colour_scale({}).has_values);
  const std::vector<double> none(5, kNaN);
  EXPECT_FALSE(make_colour_scale(none).has_values);
  EXPECT_THAT(scale_ends(make_colour_scale(none), "m"), ElementsAre("", ""));
}

TEST(ColourScale, IgnoresNonFiniteValues) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {1.0, NAN, 3.0, infinity, -infinity};
  const ColourScale scale = make_colour_scale(values);
  EXPECT_EQ(scale.low, 1.0);
  EXPECT_EQ(scale.high, 3.0);
}

TEST(ColourScale, CanStartAtZero) {
  const std::vector<double> values(10, 0.5);
  const ColourScale scale = make_colour_scale(values, ColourScale::Start::zero);
  EXPECT_EQ(scale.low, 0.0);
  EXPECT_EQ(scale.high, 0.5);
  EXPECT_EQ(scale.fraction(0.25), 0.5);
}

TEST(ScaleEnds, StateWhichEndsAreClipped) {
  const ColourScale scale{
      .low = 2.1, .high = 45.0, .clips_low = true, .clips_high = true, .has_values = true};
  EXPECT_THAT(scale_ends(scale, "m"), ElementsAre("\u2264 2.1", "\u2265 45 m"));
  EXPECT_THAT(scale_ends({.low = -3.0, .high = 1.0, .has_values = true}, ""),
              ElementsAre("\u22123", "1"));
}

TEST(ScaleNumber, HasEnoughDigitsForTheSpan) {
  EXPECT_EQ(scale_number(0.0, 1.0), "0");
  EXPECT_EQ(scale_number(12.3456, 100.0), "12");
  EXPECT_EQ(scale_number(12.3456, 1.0), "12.35");
  EXPECT_EQ(scale_number(12.3456, 0.01), "12.3456");
  EXPECT_EQ(scale_number(-0.001, 100.0), "0") << "no minus zero";
  EXPECT_EQ(scale_number(9509012.0, 9e6), "9.51e+06");
}

}  // namespace
}  // namespace glidar
