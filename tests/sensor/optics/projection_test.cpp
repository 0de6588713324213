// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/pinhole.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

Pinhole camera_with(const Distortion& distortion, double pixel_centre) {
  return {{.width = 64,
           .height = 48,
           .fx = 50.0,
           .fy = 52.0,
           .cx = 30.5,
           .cy = 25.0,
           .pixel_centre = pixel_centre},
          distortion};
}

const RadialTangential kLens = {.k1 = -0.25, .k2 = 0.07, .p1 = 0.002, .p2 = -0.001, .k3 = -0.01};

TEST(PinholeProjection, FindsThePixelOfEveryBeam) {
  for (const Distortion& lens : {Distortion(NoDistortion{}), Distortion(kLens),
                                 Distortion(Fisheye{.k1 = 0.05, .k2 = -0.01})}) {
    for (const double pixel_centre : {0.0, 0.5}) {
      const Pinhole camera = camera_with(lens, pixel_centre);
      const PinholeProjection projection(camera);
      const Beams beams = make_beams(camera);
      for (std::size_t i = 0; i < beams.directions.size(); ++i) {
        if (!(beams.directions[i].z() > 0.0)) continue;  // the lens has no ray there
        const auto pixel = projection.pixel_of(3.0 * beams.directions[i]);
        ASSERT_TRUE(pixel);
        // Newton's method stops at 1e-14 on the plane z = 1
        EXPECT_NEAR(pixel->x(), static_cast<double>(i % 64), 1e-11);
        EXPECT_NEAR(pixel->y(), static_cast<double>(i / 64), 1e-11);
        EXPECT_EQ(projection.ray_through({i % 64, i / 64}), beams.directions[i]);
      }
    }
  }
}

TEST(PinholeProjection, PointsBehindTheCameraHaveNoPixel) {
  const PinholeProjection projection(camera_with(NoDistortion{}, 0.0));
  EXPECT_FALSE(projection.pixel_of({0.1, 0.1, -1.0}));
  EXPECT_FALSE(projection.pixel_of({0.1, 0.1, 0.0}));
  EXPECT_TRUE(projection.pixel_of({100.0, 0.1, 1.0}));  // outside the image
}

TEST(PinholeProjection, PointsBeyondTheFoldOfTheLensHaveNoPixel) {
  // r (1 - r^2 / 4) has its maximum at r = 2 / sqrt(3) = 1.155; the point at r = 2 would be in the
  // middle
  const RadialTangential lens = {.k1 = -0.25};
  const PinholeProjection projection(camera_with(lens, 0.0));
  EXPECT_TRUE(projection.pixel_of({1.1, 0.0, 1.0}));
  EXPECT_FALSE(projection.pixel_of({1.2, 0.0, 1.0}));
  EXPECT_FALSE(projection.pixel_of({0.0, 2.0, 1.0}));
}

TEST(PinholeProjection, PointsBeyondTheRadiusOfTheLensHaveNoPixel) {
  const PinholeProjection projection(camera_with(RadialTangential{.max_radius = 0.5}, 0.0));
  EXPECT_TRUE(projection.pixel_of({0.3, 0.39, 1.0}));
  EXPECT_FALSE(projection.pixel_of({0.3, 0.41, 1.0}));
}

}  // namespace
}  // namespace glidar
