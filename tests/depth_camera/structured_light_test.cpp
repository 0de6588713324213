// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/structured_light.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/error_text.hpp>

#include <cmath>

namespace glidar {
namespace {

using ::testing::HasSubstr;

StructuredLight setup_of(const Distortion& distortion, FringeAxis axis) {
  StructuredLight setup;
  setup.camera.intrinsics = {64, 48, 70.0, 71.0, 31.5, 24.2, 0.0};
  setup.projector.intrinsics = {128, 80, 110.0, 112.0, 66.0, 38.0, 0.5};
  setup.projector.distortion = distortion;
  setup.projector_from_camera =
      Pose(Eigen::Translation3d(-0.12, -0.09, 0.01) *
           Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.3, 1.0, 0.1).normalized()));
  setup.patterns.axis = axis;
  return setup;
}

double scene_depth_m(std::size_t pixel) {
  return 0.8 + 0.002 * static_cast<double>(pixel % 64) + 0.1 * static_cast<double>(pixel % 7);
}

/// The coordinates at which the projector sees the points of the scene.
DecodedFringes decode_exactly(const StructuredLight& setup) {
  const PinholeIntrinsics& k = setup.camera.intrinsics;
  const Beams beams = make_beams(setup.camera);
  const PinholeProjection projection(setup.projector);
  DecodedFringes decoded = {k.width, k.height};
  for (std::size_t i = 0; i < beams.directions.size(); ++i) {
    const Eigen::Vector3d point = beams.directions[i] / beams.directions[i].z() * scene_depth_m(i);
    const auto pixel = projection.pixel_of(setup.projector_from_camera * point);
    const int axis = setup.patterns.axis == FringeAxis::columns ? 0 : 1;
    decoded.coordinate_px.push_back(pixel ? static_cast<float>((*pixel)[axis]) : kNaNf);
  }
  return decoded;
}

TEST(StructuredLight, FindsTheDepthsOfTheCoordinates) {
  const RadialTangential lens = {.k1 = 0.1, .k2 = -0.15, .p1 = 0.002, .p2 = -0.001, .k3 = 0.05};
  for (const Distortion& distortion : {Distortion(NoDistortion{}), Distortion(lens)}) {
    for (const FringeAxis axis : {FringeAxis::columns, FringeAxis::rows}) {
      const StructuredLight setup = setup_of(distortion, axis);
      const std::vector<float> depth_m = triangulate(decode_exactly(setup), setup);
      for (std::size_t i = 0; i < depth_m.size(); ++i) {
        // float stores coordinates of 64 and more to 4e-6 px, which are z^2 / (f b) of depth each.
        EXPECT_NEAR(depth_m[i], scene_depth_m(i), 4e-6 * 4.0 / (110.0 * 0.08)) << i;
      }
    }
  }
}

TEST(StructuredLight, CoordinatesWithoutIntersectionHaveNoDepth) {
  const StructuredLight setup = setup_of(NoDistortion{}, FringeAxis::columns);
  DecodedFringes decoded = decode_exactly(setup);
  decoded.coordinate_px[5] = kNaNf;
  decoded.coordinate_px[6] = 100000.0F;  // behind the camera or the projector
  decoded.coordinate_px[7] = -100000.0F;
  const std::vector<float> depth_m = triangulate(decoded, setup);
  EXPECT_TRUE(std::isnan(depth_m[5]));
  EXPECT_FALSE(std::isnan(depth_m[8]));
  EXPECT_TRUE(std::isnan(depth_m[6]) || std::isnan(depth_m[7]));
}

/// Images of a scene that shows the camera each pattern, displaced by some pixels.
std::vector<GreyImage> displaced_patterns(const StructuredLight& setup, std::uint32_t shift_px) {
  const PinholeIntrinsics& k = setup.camera.intrinsics;
  std::vector<GreyImage> images;
  for (std::size_t i = 0; i < image_count(setup.patterns); ++i) {
    const std::vector<std::uint16_t> line = pattern_line(setup.patterns, i);
    GreyImage image = {k.width, k.height};
    for (std::uint32_t pixel = 0; pixel < k.width * k.height; ++pixel) {
      const std::uint32_t level = line[(pixel % k.width + shift_px) % line.size()];
      image.level.push_back(static_cast<std::uint16_t>(level * 9 / 10));  // none is saturated
    }
    images.push_back(std::move(image));
  }
  return images;
}

TEST(StructuredLight, PixelsAreValidOnlyIfTheyHaveADepth) {
  StructuredLight setup;
  setup.camera.intrinsics = {
      .width = 64, .height = 2, .fx = 60.0, .fy = 60.0, .cx = 32.0, .cy = 1.0};
  setup.projector = setup.camera;
  setup.projector_from_camera.translation().x() = 1.0;
  setup.patterns = {.width = 64, .height = 2, .period_px = 16.0};
  const std::vector<GreyImage> images = displaced_patterns(setup, 62);
  ThreadPool pool(2);
  const MeasuredFringes measured = measure_fringes(images, setup, &pool);
  std::size_t inconsistent = 0;
  for (std::uint32_t i = 0; i < measured.depth_m.size(); ++i) {
    const FringeStatus status = measured.decoded.status[i];
    EXPECT_EQ(status == FringeStatus::valid, !std::isnan(measured.depth_m[i])) << i;
    EXPECT_EQ(status == FringeStatus::valid, !std::isnan(measured.decoded.coordinate_px[i])) << i;
    EXPECT_EQ(explain_fringes(images, setup, {i % 64, i / 64}).status, status) << i;
    inconsistent += status == FringeStatus::inconsistent ? 1U : 0U;
  }
  EXPECT_GT(inconsistent, 100U);
  EXPECT_THAT(format_fringe_trace(explain_fringes(images, setup, {30, 1})),
              HasSubstr("failed  inconsistent: the coordinate leads to no depth"));
}

TEST(StructuredLight, ImagesOfAnotherSizeAreAnError) {
  const StructuredLight setup = setup_of(NoDistortion{}, FringeAxis::columns);
  DecodedFringes decoded = decode_exactly(setup);
  decoded.width = 48;
  decoded.height = 64;
  EXPECT_THAT(error_text([&] { triangulate(decoded, setup); }), HasSubstr("64x48, as the camera"));
}

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
