// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>

#include <gtest/gtest.h>

#include <cstdlib>

namespace glidar::app {
namespace {

int apart(Colour a, Colour b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

TEST(Hue, CoversTheCircleOfPureColours) {
  EXPECT_EQ(apart(hue(0.0), {255, 0, 0}), 0);
  EXPECT_EQ(apart(hue(1.0 / 6.0), {255, 255, 0}), 0);
  EXPECT_EQ(apart(hue(1.0 / 3.0), {0, 255, 0}), 0);
  EXPECT_EQ(apart(hue(0.5), {0, 255, 255}), 0);
  EXPECT_EQ(apart(hue(2.0 / 3.0), {0, 0, 255}), 0);
  EXPECT_EQ(apart(hue(5.0 / 6.0), {255, 0, 255}), 0);
  EXPECT_EQ(apart(hue(1.25), hue(0.25)), 0);
}

TEST(ColourOf, ClampsBeyondZeroAndOne) {
  for (const ColourMap map : {ColourMap::viridis, ColourMap::rainbow, ColourMap::grey}) {
    EXPECT_EQ(apart(colour_of(map, -3.0), colour_of(map, 0.0)), 0);
    EXPECT_EQ(apart(colour_of(map, 7.0), colour_of(map, 1.0)), 0);
    EXPECT_GT(apart(colour_of(map, 0.0), colour_of(map, 1.0)), 300);
  }
}

TEST(ColourOf, RainbowRunsFromBlueToRedAndGreyIsLinear) {
  EXPECT_EQ(apart(colour_of(ColourMap::rainbow, 0.0), {0, 0, 255}), 0);
  EXPECT_EQ(apart(colour_of(ColourMap::rainbow, 1.0), {255, 0, 0}), 0);
  EXPECT_EQ(apart(colour_of(ColourMap::grey, 0.5), {128, 128, 128}), 0);
}

TEST(CategoryColour, DiffersForTheFirstSixteen) {
  for (std::uint32_t a = 0; a < 16; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      EXPECT_GT(apart(category_colour(a), category_colour(b)), 40) << a << " and " << b;
    }
  }
}

}  // namespace
}  // namespace glidar::app
