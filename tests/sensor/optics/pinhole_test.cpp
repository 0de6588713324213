// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>

// Camera models against numbers of OpenCV and formulas that are written as in their papers.

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

const RadialTangential kTilted = {.k1 = -0.28,
                                  .k2 = 0.07,
                                  .p1 = 0.002,
                                  .p2 = -0.001,
                                  .k3 = -0.01,
                                  .k4 = 0.02,
                                  .k5 = -0.01,
                                  .k6 = 0.003,
                                  .s1 = 0.004,
                                  .s2 = -0.002,
                                  .s3 = -0.003,
                                  .s4 = 0.001,
                                  .tau_x = 0.05,
                                  .tau_y = -0.03};
const Omni kMirror = {1.2, {.k1 = -0.2, .k2 = 0.05, .p1 = 0.001, .p2 = -0.002}};

/// Focal lengths and principal point of all cameras here, for OpenCV's pixel centres.
Pinhole camera_of(const Distortion& model, double skew_px = 0.0) {
  return {{.width = 660,
           .height = 500,
           .fx = 500.0,
           .fy = 510.0,
           .cx = 330.0,
           .cy = 250.0,
           .pixel_centre = 0.0},
          model,
          skew_px};
}

struct Imaged {
  Eigen::Vector3d point;
  Eigen::Vector2d pixel;
};

void expect_images(const Pinhole& camera, const std::array<Imaged, 4>& images) {
  const PinholeProjection projection(camera);
  for (const Imaged& expected : images) {
    const auto pixel = projection.pixel_of(expected.point);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR((*pixel - expected.pixel).norm(), 0.0, 1e-9);
    const Eigen::Vector3d ray = projection.ray_through(expected.pixel);
    EXPECT_NEAR((ray - expected.point.normalized()).norm(), 0.0, 1e-11);
  }
}

TEST(CameraModels, ThinPrismsAndTiltedSensorsAreThoseOfOpenCv) {
  // cv2.projectPoints of OpenCV 5.0 with 12 and 14 coefficients
  RadialTangential prism = kTilted;
  prism.tau_x = prism.tau_y = 0.0;
  expect_images(camera_of(prism), {{{{0.3, -0.2, 1.0}, {474.3303583582862, 151.91878331636536}},
                                    {{-0.5, 0.4, 1.1}, {123.59315987635156, 418.6347821692695}},
                                    {{0.05, 0.6, 0.9}, {355.02682588676254, 550.4370608452855}},
                                    {{0.7, 0.1, 1.5}, {548.8528908061612, 281.7604688508025}}}});
  expect_images(camera_of(kTilted), {{{{0.3, -0.2, 1.0}, {474.25820428850903, 152.11018077279772}},
                                      {{-0.5, 0.4, 1.1}, {122.64115747351181, 419.23075509926855}},
                                      {{0.05, 0.6, 0.9}, {355.8386544069406, 560.47068485921}},
                                      {{0.7, 0.1, 1.5}, {552.572198062905, 282.66685744084054}}}});
}

TEST(CameraModels, UnifiedCamerasWithSkewAreThoseOfOpenCv) {
  // cv2.omnidir.projectPoints of OpenCV 5.0; two points are behind the camera
  expect_images(camera_of(kMirror, 3.5),
                {{{{0.3, -0.2, 1.0}, {395.21007810009974, 205.44495565300346}},
                  {{-1.5, 0.4, 0.2}, {2.655085433954355, 339.33737394656316}},
                  {{0.05, 1.6, -0.3}, {344.94413452465625, 673.8671217471012}},
                  {{2.0, 0.1, -0.9}, {800.2925537902801, 274.72398632075675}}}});
}

/// The place of a direction by the formula of the model's paper.
using Formula = Eigen::Vector2d (*)(const Eigen::Vector3d&);

struct Model {
  const char* name;
  Distortion model;
  Formula formula;
  double max_angle;  ///< from the axis, up to which points are imaged
};

void PrintTo(const Model& model, std::ostream* out) {
  *out << model.name;
}

const std::array kModels = {
    Model{"double_sphere", DoubleSphere{-0.2, 0.59},
          [](const Eigen::Vector3d& p) -> Eigen::Vector2d {
            const double d1 = p.norm();  // equations 40 to 42
            const double d2 = std::hypot(p.x(), p.y(), -0.2 * d1 + p.z());
            return p.head<2>() / (0.59 * d2 + (1 - 0.59) * (-0.2 * d1 + p.z()));
          },
          1.8},
    Model{"extended_unified", ExtendedUnified{0.6, 1.1},
          [](const Eigen::Vector3d& p) -> Eigen::Vector2d {
            const double d = std::sqrt(1.1 * (p.x() * p.x() + p.y() * p.y()) + p.z() * p.z());
            return p.head<2>() / (0.6 * d + (1 - 0.6) * p.z());
          },
          1.8},
    Model{"fov", FieldOfView{0.93},
          [](const Eigen::Vector3d& p) -> Eigen::Vector2d {
            const double r = p.head<2>().norm() / p.z();
            return p.head<2>() / p.head<2>().norm() * std::atan(2 * r * std::tan(0.465)) / 0.93;
          },
          1.5},
    Model{"fisheye", Fisheye{0.02, -0.003, 0.0, 0.0},
          [](const Eigen::Vector3d& p) -> Eigen::Vector2d {
            const double t = std::acos(p.z() / p.norm());
            return p.head<2>().normalized() * (t + 0.02 * std::pow(t, 3) - 0.003 * std::pow(t, 5));
          },
          2.2},
    Model{"equirectangular", Equirectangular{},
          [](const Eigen::Vector3d& p) -> Eigen::Vector2d {
            return {std::atan2(p.x(), p.z()), std::asin(p.y() / p.norm())};
          },
          3.1}};

class CameraModels : public ::testing::TestWithParam<Model> {};

/// Directions all over the part of space that the model images.
std::vector<Eigen::Vector3d> directions_to(double max_angle) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 1; i <= 24; ++i)
    for (int j = 0; j < 17; ++j) {
      const double theta = max_angle * i / 24.0;
      const double phi = kTwoPi * (j + 0.3) / 17.0;
      points.emplace_back(2.5 * std::sin(theta) * std::cos(phi),
                          2.5 * std::sin(theta) * std::sin(phi), 2.5 * std::cos(theta));
    }
  return points;
}

TEST_P(CameraModels, ImagesFollowTheFormulaOfThePaperAndRaysReturn) {
  const Pinhole camera = camera_of(GetParam().model);
  const PinholeProjection projection(camera);
  for (const Eigen::Vector3d& point : directions_to(GetParam().max_angle)) {
    const Eigen::Vector2d place = GetParam().formula(point);
    const Eigen::Vector2d expected(500.0 * place.x() + 330.0, 510.0 * place.y() + 250.0);
    const auto pixel = projection.pixel_of(point);
    ASSERT_TRUE(pixel) << point.transpose();
    EXPECT_NEAR((*pixel - expected).norm(), 0.0, 1e-9) << point.transpose();
    const Eigen::Vector3d ray = projection.ray_through(*pixel);
    EXPECT_NEAR((ray - point.normalized()).norm(), 0.0, 1e-11) << point.transpose();
  }
}

TEST_P(CameraModels, DerivativesAreTheDifferencesOfImages) {
  const PinholeProjection projection(camera_of(GetParam().model, 7.0));
  constexpr double kStep = 1e-5;
  for (const Eigen::Vector3d& point : directions_to(GetParam().max_angle)) {
    const Eigen::Matrix<double, 2, 3> derivative = projection.pixel_derivative(point);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      const auto ahead = projection.pixel_of(point + step);
      const auto behind = projection.pixel_of(point - step);
      ASSERT_TRUE(ahead && behind);
      const Eigen::Vector2d difference = (*ahead - *behind) / (2.0 * kStep);
      EXPECT_NEAR((derivative.col(axis) - difference).norm(), 0.0, 1e-4 * (1 + difference.norm()))
          << point.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CameraModels, ::testing::ValuesIn(kModels),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(CameraModels, DerivativesOfDistortedImagesAreTheDifferences) {
  for (const Distortion& model :
       {Distortion(NoDistortion{}), Distortion(kTilted), Distortion(kMirror)}) {
    const PinholeProjection projection(camera_of(model, 2.0));
    constexpr double kStep = 1e-6;
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.3, -0.2, 1.0), Eigen::Vector3d(0.0, 0.0, 2.0)}) {
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector2d difference =
            (*projection.pixel_of(point + step) - *projection.pixel_of(point - step)) /
            (2.0 * kStep);
        EXPECT_NEAR((projection.pixel_derivative(point).col(axis) - difference).norm(), 0.0, 1e-4);
      }
    }
  }
}

TEST(CameraModels, PointsOutsideTheImagedSpaceHaveNoPixelAndNoRay) {
  const auto pixel_at = [](const Distortion& model, double angle) {
    return PinholeProjection(camera_of(model)).pixel_of({std::sin(angle), 0.0, std::cos(angle)});
  };
  // alpha > 0.5: the image ends at r^2 = 1 / (2 alpha - 1), which is the last angle
  const double edge = 500.0 / std::sqrt(2 * 0.59 - 1.0);
  const PinholeProjection spheres(camera_of(DoubleSphere{-0.2, 0.59}));
  EXPECT_TRUE(spheres.ray_through({330.0 + 0.999 * edge, 250.0}).allFinite());
  EXPECT_FALSE(spheres.ray_through({330.0 + 1.001 * edge, 250.0}).allFinite());
  const double last = std::acos(spheres.ray_through({330.0 + (1.0 - 1e-12) * edge, 250.0}).z());
  EXPECT_TRUE(pixel_at(DoubleSphere{-0.2, 0.59}, last - 0.001));
  EXPECT_FALSE(pixel_at(DoubleSphere{-0.2, 0.59}, last + 0.001));
  EXPECT_FALSE(pixel_at(FieldOfView{0.93}, 1.58));
  EXPECT_TRUE(pixel_at(Fisheye{}, 3.1));
  EXPECT_FALSE(pixel_at(Fisheye{.k1 = -0.1}, 2.0));  // folds at 1.826
  EXPECT_FALSE(PinholeProjection(camera_of(Equirectangular{})).pixel_of({0.0, 0.0, 0.0}));
}

TEST(CameraModels, PanoramasHaveEveryDirectionOnce) {
  Pinhole camera;
  camera.intrinsics = {.width = 64,
                       .height = 32,
                       .fx = 64 / kTwoPi,
                       .fy = 32 / std::numbers::pi,
                       .cx = 32.0,
                       .cy = 16.0,
                       .pixel_centre = 0.5};
  camera.distortion = Equirectangular{};
  const Beams beams = make_beams(camera);
  for (std::uint32_t v = 0; v < 32; ++v)
    for (std::uint32_t u = 0; u < 64; ++u) {
      const double longitude = (u + 0.5 - 32.0) * kTwoPi / 64;
      const double latitude = (v + 0.5 - 16.0) * std::numbers::pi / 32;
      const Eigen::Vector3d expected(std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                                     std::cos(latitude) * std::cos(longitude));
      EXPECT_NEAR((beams.directions[64 * v + u] - expected).norm(), 0.0, 1e-14);
    }
}

TEST(CameraModels, SkewShiftsColumnsByTheRow) {
  const Pinhole camera = camera_of(NoDistortion{}, 25.0);
  const Beams beams = make_beams(camera);
  EXPECT_FALSE(beams.pinhole.has_value());  // rasterisers know no skew
  for (const std::size_t i : {std::size_t{0}, std::size_t{660 * 400 + 123}}) {
    const Eigen::Vector3d place = beams.directions[i] / beams.directions[i].z();
    EXPECT_NEAR(500.0 * place.x() + 25.0 * place.y() + 330.0, static_cast<double>(i % 660), 1e-10);
    EXPECT_NEAR(510.0 * place.y() + 250.0, static_cast<double>(i / 660), 1e-10);
  }
}

}  // namespace

}  // namespace glidar
