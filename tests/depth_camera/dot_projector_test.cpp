// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/dot_projector.hpp>

#include <glidar/math/constants.hpp>

#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

using ::testing::HasSubstr;

DotProjector narrow_projector() {
  DotProjector projector;
  projector.fov_x_rad = 30.0 * kDegree;
  projector.fov_y_rad = 20.0 * kDegree;
  projector.dots = 300;
  return projector;
}

/// A projector of a picture with one level everywhere.
DotProjector flat_projector(double fov_rad) {
  DotProjector projector;
  projector.fov_x_rad = fov_rad;
  projector.fov_y_rad = fov_rad;
  projector.pattern = {
      .width = 512, .height = 512, .level = std::vector<std::uint16_t>(512 * 512, 7)};
  return projector;
}

double nearest_distance(const std::vector<Dot>& dots, std::size_t dot) {
  double nearest = 1e9;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    if (i != dot) nearest = std::min(nearest, (dots[i].centre - dots[dot].centre).norm());
  }
  return nearest;
}

TEST(DotProjector, PlacesTheRequestedDotsAtLeastSevenTenthsOfTheMeanSpacingApart) {
  const DotProjector projector = narrow_projector();
  const std::vector<Dot> dots = place_dots(projector);
  ASSERT_EQ(dots.size(), projector.dots);
  const double half_x = std::tan(15.0 * kDegree);
  const double half_y = std::tan(10.0 * kDegree);
  const double mean_spacing = std::sqrt(4.0 * half_x * half_y / projector.dots);
  for (std::size_t i = 0; i < dots.size(); ++i) {
    EXPECT_LE(std::abs(dots[i].centre.x()), half_x);
    EXPECT_LE(std::abs(dots[i].centre.y()), half_y);
    EXPECT_GE(nearest_distance(dots, i), 0.7 * mean_spacing * (1.0 - 1e-12)) << i;
  }
}

TEST(DotProjector, PlacesTheSameDotsForTheSameSeedOnly) {
  DotProjector projector = narrow_projector();
  const Dot dot = place_dots(projector).back();
  EXPECT_EQ(place_dots(projector).back().centre, dot.centre);
  EXPECT_EQ(place_dots(projector).back().brightness, dot.brightness);
  projector.pattern_seed = 2;
  EXPECT_NE(place_dots(projector).back().centre, dot.centre);
}

/// The integral of the intensity over all directions, by polar angles.
double total_power_w(const IntensityMap& map) {
  constexpr int kSteps = 1000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double from_axis = (i + 0.5) / kSteps * 0.5;  // radians, beyond the corner of the field
    for (int k = 0; k < kSteps; ++k) {
      const double around = (k + 0.5) / kSteps * kTwoPi;
      const double tangent = std::tan(from_axis);
      sum += intensity_at(map, tangent * std::cos(around), tangent * std::sin(around)) *
             std::sin(from_axis);
    }
  }
  return sum * 0.5 / kSteps * kTwoPi / kSteps;
}

TEST(DotProjector, SendsItsPowerIntoAllDirectionsTogether) {
  const DotProjector projector = narrow_projector();
  EXPECT_NEAR(total_power_w(make_intensity_map(projector)), projector.power_w,
              5e-3 * projector.power_w);  // the sum above takes 8 samples of a dot
}

// The solid angle of a rectangle at distance 1 with half sides a, b: 4 atan(a b / sqrt(1 + a² +
// b²)).
TEST(DotProjector, OfAFlatPictureHasThePowerOverTheSolidAngle) {
  const DotProjector projector = flat_projector(60.0 * kDegree);
  const double a = std::tan(30.0 * kDegree);
  const double solid_angle = 4.0 * std::atan(a * a / std::sqrt(1.0 + 2.0 * a * a));
  const IntensityMap map = make_intensity_map(projector);
  EXPECT_NEAR(intensity_at(map, 0.1, -0.2), projector.power_w / solid_angle,
              1e-5 * projector.power_w);
  EXPECT_EQ(intensity_at(map, 0.6, 0.0), 0.0) << "beyond the field";
  EXPECT_EQ(intensity_at(map, kNaN, 0.0), 0.0);
}

TEST(DotProjector, HasGaussianDotsOfTheirWidth) {
  DotProjector projector = narrow_projector();
  projector.dots = 1;
  const Eigen::Vector2d dot = place_dots(projector).front().centre;
  const IntensityMap map = make_intensity_map(projector);
  const double peak = intensity_at(map, dot.x(), dot.y());
  const double half_width = 0.5 * projector.dot_width_rad;
  EXPECT_NEAR(intensity_at(map, dot.x() + half_width, dot.y()) / peak, 0.5, 0.02);
  EXPECT_NEAR(intensity_at(map, dot.x(), dot.y() - half_width) / peak, 0.5, 0.02);
}

TEST(DotProjector, RefusesPatternsWithoutLightAndTooFineDots) {
  DotProjector dark = flat_projector(1.0);
  std::fill(dark.pattern.level.begin(), dark.pattern.level.end(), 0);
  EXPECT_THAT(error_text([&] { make_intensity_map(dark); }), HasSubstr("a pattern without light"));
  DotProjector fine;
  fine.dot_width_rad = 1e-4;
  EXPECT_THAT(error_text([&] { make_intensity_map(fine); }), HasSubstr("use wider dots"));
}

}  // namespace
}  // namespace glidar
