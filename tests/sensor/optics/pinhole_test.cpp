// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace glidar {
namespace {

TEST(Pinhole, FillsItsFieldOfView) {
  const Beams beams = make_beams(pinhole_from_fov(4, 2, 20.0 * kDegree));
  ASSERT_EQ(beams.size(), 8U);
  EXPECT_EQ(beams.frame_id, "camera_optical_frame");
  // The outer borders of the pixels lie at 10 degrees; centres half a pixel inside.
  const Eigen::Vector3d top_left = beams.directions[0];
  EXPECT_NEAR(top_left.y() / top_left.z(), -0.5 * std::tan(10.0 * kDegree), 1e-15);
  EXPECT_NEAR(top_left.x() / top_left.z(), -1.5 * std::tan(10.0 * kDegree), 1e-15);
}

TEST(Pinhole, PutsPixelCentresAtTheGivenOffset) {
  Pinhole pinhole;
  pinhole.intrinsics = {.width = 3, .height = 1, .fx = 100.0, .fy = 100.0, .cx = 1.0, .cy = 0.0};
  pinhole.intrinsics.pixel_centre = 0.0;
  const Beams beams = make_beams(pinhole);
  EXPECT_EQ(beams.directions[1], Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(beams.directions[2].x() / beams.directions[2].z(), 0.01, 1e-16);
}

TEST(Pinhole, KeepsItsIntrinsicsForRasterisersUnlessDistorted) {
  Pinhole pinhole = pinhole_from_fov(8, 8, 1.0);
  const Beams beams = make_beams(pinhole);
  ASSERT_TRUE(beams.pinhole.has_value());
  const PinholeIntrinsics& k = *beams.pinhole;
  for (std::uint32_t v = 0; v < k.height; ++v) {
    for (std::uint32_t u = 0; u < k.width; ++u) {
      const Eigen::Vector3d expected = direction_through(plane_x(k, u), plane_y(k, v));
      ASSERT_EQ(beams.directions[std::size_t{v} * k.width + u], expected);  // bit for bit
    }
  }
  pinhole.distortion = RadialTangential{.k1 = 0.1};
  EXPECT_FALSE(make_beams(pinhole).pinhole.has_value());
}

/// The documented forward models, written again.
Eigen::Vector2d distort(const RadialTangential& k, double x, double y) {
  const double r2 = x * x + y * y;
  const double r4 = r2 * r2;
  const double r6 = r4 * r2;
  const double f =
      (1 + k.k1 * r2 + k.k2 * r4 + k.k3 * r6) / (1 + k.k4 * r2 + k.k5 * r4 + k.k6 * r6);
  return {x * f + 2 * k.p1 * x * y + k.p2 * (r2 + 2 * x * x),
          y * f + k.p1 * (r2 + 2 * y * y) + 2 * k.p2 * x * y};
}

Eigen::Vector2d distort(const Fisheye& k, const Eigen::Vector3d& d) {
  const double theta = std::atan2(std::hypot(d.x(), d.y()), d.z());
  const double t2 = theta * theta;
  const double thetad =
      theta * (1 + k.k1 * t2 + k.k2 * t2 * t2 + k.k3 * t2 * t2 * t2 + k.k4 * t2 * t2 * t2 * t2);
  const double r = std::hypot(d.x(), d.y());
  return r == 0.0 ? Eigen::Vector2d::Zero()
                  : Eigen::Vector2d(d.x() / r * thetad, d.y() / r * thetad);
}

/// Every beam, distorted forwards, must land on its pixel.
void expect_pixels(const Pinhole& pinhole,
                   const std::function<Eigen::Vector2d(const Eigen::Vector3d&)>& forward) {
  const Beams beams = make_beams(pinhole);
  const PinholeIntrinsics& k = pinhole.intrinsics;
  for (std::uint32_t v = 0; v < k.height; ++v) {
    for (std::uint32_t u = 0; u < k.width; ++u) {
      const Eigen::Vector3d& d = beams.directions[std::size_t{v} * k.width + u];
      ASSERT_FALSE(std::isnan(d.x())) << u << " " << v;
      const Eigen::Vector2d plane = forward(d);
      EXPECT_NEAR(k.fx * plane.x() + k.cx, u + k.pixel_centre, 1e-9);
      EXPECT_NEAR(k.fy * plane.y() + k.cy, v + k.pixel_centre, 1e-9);
    }
  }
}

TEST(RadialTangentialOptics, InvertTheModelOfOpenCv) {
  // A real calibration's size of numbers (a 640x480 depth camera).
  const RadialTangential k{.k1 = 0.2, .k2 = -0.6, .p1 = 0.001, .p2 = -0.002, .k3 = 0.5};
  const Pinhole pinhole{{.width = 64, .height = 48, .fx = 57.0, .fy = 57.5, .cx = 31.3, .cy = 24.2},
                        k};
  expect_pixels(pinhole,
                [&](const Eigen::Vector3d& d) { return distort(k, d.x() / d.z(), d.y() / d.z()); });
}

TEST(RadialTangentialOptics, InvertTheRationalModel) {
  const RadialTangential k{
      .k1 = 0.5, .k2 = 0.1, .p1 = 1e-4, .p2 = 1e-4, .k3 = 0.01, .k4 = 0.8, .k5 = 0.2, .k6 = 0.02};
  const Pinhole pinhole{{.width = 40, .height = 30, .fx = 20.0, .fy = 20.0, .cx = 20.0, .cy = 15.0},
                        k};
  expect_pixels(pinhole,
                [&](const Eigen::Vector3d& d) { return distort(k, d.x() / d.z(), d.y() / d.z()); });
}

TEST(RadialTangentialOptics, HaveNoBeamWhereTheModelFoldsOver) {
  // r (1 - r^2) has its largest value 0.385 at r = 0.577: no ray lands beyond.
  const Pinhole pinhole{{.width = 100, .height = 1, .fx = 100.0, .fy = 100.0, .cx = 0.0, .cy = 0.5},
                        RadialTangential{.k1 = -1.0}};
  const Beams beams = make_beams(pinhole);
  EXPECT_FALSE(std::isnan(beams.directions[37].x()));  // 0.375
  EXPECT_TRUE(std::isnan(beams.directions[39].x()));   // 0.395
  EXPECT_TRUE(std::isnan(beams.directions[99].x()));
}

TEST(FisheyeOptics, InvertTheModelOfOpenCvBeyondNinetyDegrees) {
  const Fisheye k{.k1 = -0.02, .k2 = 0.003, .k3 = -0.001, .k4 = 1e-4};
  const Pinhole pinhole{{.width = 61, .height = 61, .fx = 20.0, .fy = 20.0, .cx = 30.5, .cy = 30.5},
                        k};
  expect_pixels(pinhole, [&](const Eigen::Vector3d& d) { return distort(k, d); });
  EXPECT_LT(make_beams(pinhole).directions[0].z(), 0.0);
}

TEST(FisheyeOptics, HaveNoBeamBeyondTheWholeSphere) {
  const Pinhole pinhole{{.width = 1, .height = 1, .fx = 1.0, .fy = 1.0, .cx = -3.0, .cy = 0.5},
                        Fisheye{}};
  EXPECT_TRUE(std::isnan(make_beams(pinhole).directions[0].x()));  // theta 3.5 > pi
}

TEST(Pinhole, RejectsInvalidIntrinsics) {
  EXPECT_THROW(pinhole_from_fov(0, 8, 1.0), Error);
  EXPECT_THROW(pinhole_from_fov(70000, 8, 1.0), Error);
  EXPECT_THROW(pinhole_from_fov(8, 8, 0.0), Error);
  EXPECT_THROW(pinhole_from_fov(8, 8, std::numbers::pi), Error);
  EXPECT_THROW(pinhole_from_fov(8, 8, std::nan("")), Error);
  Pinhole pinhole = pinhole_from_fov(8, 8, 1.0);
  pinhole.intrinsics.fx = -1.0;
  EXPECT_EQ(error_text([&] { make_beams(pinhole); }),
            "pinhole, fx: -1; allowed: above 0, up to 1e9 pixels");
}

}  // namespace
}  // namespace glidar
