// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/structured_light.hpp>

#include <glidar/math/constants.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

// The integral of cos^3 over the plane z = 1, by the midpoint rule with 10^6 cells: 1e-6.
TEST(ProjectorLight, SpreadsItsPowerOverTheSolidAngleOfItsImage) {
  const Pinhole projector = {{.width = 1280,
                              .height = 800,
                              .fx = 900.0,
                              .fy = 950.0,
                              .cx = 1400.0,
                              .cy = 300.0,
                              .pixel_centre = 0.0},
                             NoDistortion{}};
  double solid_angle_sr = 0.0;
  constexpr int kCells = 1000;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const double x = (1280.0 * (i + 0.5) / kCells - 0.5 - 1400.0) / 900.0;
      const double y = (800.0 * (j + 0.5) / kCells - 0.5 - 300.0) / 950.0;
      solid_angle_sr += std::pow(1.0 + x * x + y * y, -1.5);
    }
  }
  solid_angle_sr *= 1280.0 / 900.0 * 800.0 / 950.0 / (kCells * kCells);
  EXPECT_NEAR(white_intensity_w_per_sr(projector, 2.5), 2.5 / solid_angle_sr,
              1e-5 * 2.5 / solid_angle_sr);
}

// The levels are whole: an error of 1/510.
TEST(ProjectorLight, RaisesLevelsToItsGamma) {
  const FringePatterns patterns = {.width = 640, .height = 8};
  const std::vector<float> line = projected_line(patterns, {.gamma = 2.2, .blur_px = 0.0}, 1);
  const GreyImage pattern = make_pattern(patterns, 1);
  ASSERT_EQ(line.size(), 640U);
  for (std::size_t x = 0; x < line.size(); ++x) {
    EXPECT_NEAR(double{line[x]}, std::pow(pattern.level[x] / 255.0, 2.2), 1e-7) << x;
  }
}

// A Gaussian takes exp(-2 pi^2 s^2 / T^2) of the contrast of fringes.
TEST(ProjectorLight, LosesContrastByItsPointSpread) {
  const FringePatterns patterns = {.width = 640, .height = 8, .period_px = 16.0};
  const std::vector<float> line = projected_line(patterns, {.blur_px = 2.0}, 0);
  const double contrast = std::exp(-0.5 * kTwoPi * kTwoPi * 4.0 / 256.0);
  for (std::size_t x = 16; x < 624; ++x) {
    const double turns = (static_cast<double>(x) + 0.5) / 16.0;
    EXPECT_NEAR(double{line[x]}, 0.5 + 0.5 * contrast * std::cos(kTwoPi * turns), 1.0 / 510.0) << x;
  }
}

TEST(ProjectorLight, IsLinearBetweenPixelsAndEvenBeyondThem) {
  const std::vector<float> line = {0.0F, 0.5F, 0.25F};
  EXPECT_EQ(light_at(line, -0.5F), 0.0F);
  EXPECT_EQ(light_at(line, 0.5F), 0.25F);
  EXPECT_EQ(light_at(line, 1.0F), 0.5F);
  EXPECT_EQ(light_at(line, 1.5F), 0.375F);
  EXPECT_EQ(light_at(line, 2.4F), 0.25F);
}

TEST(ProjectorLight, OfRowsHasTheHeightOfTheImage) {
  const FringePatterns patterns = {.width = 640, .height = 80, .axis = FringeAxis::rows};
  EXPECT_EQ(projected_line(patterns, {}, 0).size(), 80U);
}

}  // namespace
}  // namespace glidar
