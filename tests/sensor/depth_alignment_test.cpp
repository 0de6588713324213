// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/depth_alignment.hpp>

#include <glidar/core/error.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <algorithm>

namespace glidar {
namespace {

using testing::Each;
using testing::HasSubstr;

Pinhole camera_of(std::uint32_t width, std::uint32_t height) {
  return pinhole_from_fov(width, height, 0.9);
}

DepthImage plane_of(std::uint32_t width, std::uint32_t height, std::uint16_t depth) {
  return {width, height, std::vector<std::uint16_t>(std::size_t{width} * height, depth)};
}

TEST(DepthAligner, TheSameCameraHasTheSameImage) {
  const DepthAligner aligner({.depth = camera_of(20, 16), .colour = camera_of(20, 16)});
  const AlignedDepth aligned = aligner.align(plane_of(20, 16, 900));
  EXPECT_THAT(aligned.image.depth, Each(900));
  EXPECT_THAT(aligned.source, Each(testing::Lt(320U)));
}

TEST(DepthAligner, AFinerImageHasNoGaps) {
  const DepthAligner aligner({.depth = camera_of(20, 16), .colour = camera_of(75, 60)});
  const AlignedDepth aligned = aligner.align(plane_of(20, 16, 900));
  EXPECT_EQ(aligned.image.width, 75U);
  EXPECT_THAT(aligned.image.depth, Each(900));
}

TEST(DepthAligner, ParallaxIsFocalLengthTimesBaselineOverDepth) {
  const Pinhole camera = camera_of(80, 60);
  const double depth_m = 1.0;
  const double shift_px = 10.0;
  DepthAlignment alignment = {.depth = camera, .colour = camera};
  alignment.colour_from_depth.translation().x() = shift_px * depth_m / camera.intrinsics.fx;
  DepthImage image = plane_of(80, 60, 0);
  image.depth[30 * 80 + 40] = 1000;
  const AlignedDepth aligned = DepthAligner(alignment).align(image);
  EXPECT_EQ(aligned.image.depth[30 * 80 + 50], 1000);
  EXPECT_EQ(aligned.source[30 * 80 + 50], 30U * 80 + 40);
  EXPECT_EQ(aligned.source[30 * 80 + 47], kNoSource);
}

TEST(DepthAligner, TheNearestDepthRemains) {
  DepthAlignment alignment = {.depth = camera_of(40, 30), .colour = camera_of(40, 30)};
  alignment.colour_from_depth.translation().x() = 0.1;
  DepthImage image = plane_of(40, 30, 3000);
  for (std::uint32_t y = 0; y < 30; ++y) image.depth[y * 40 + 10] = 500;
  const AlignedDepth aligned = DepthAligner(alignment).align(image);
  EXPECT_GE(std::count(aligned.image.depth.begin(), aligned.image.depth.end(), 500), 30);
}

TEST(DepthAligner, DepthsAreThoseOfTheColourCameraUnlessTheyAreKept) {
  DepthAlignment alignment = {.depth = camera_of(40, 30), .colour = camera_of(40, 30)};
  alignment.colour_from_depth.translation().z() = 0.25;
  for (const bool keeps_depth : {false, true}) {
    alignment.keeps_depth = keeps_depth;
    const AlignedDepth aligned = DepthAligner(alignment).align(plane_of(40, 30, 2000));
    EXPECT_EQ(aligned.image.depth[15 * 40 + 20], keeps_depth ? 2000 : 2250);
  }
}

TEST(DepthAligner, DepthsBehindTheColourCameraAreNotSeen) {
  DepthAlignment alignment = {.depth = camera_of(40, 30), .colour = camera_of(40, 30)};
  alignment.colour_from_depth.translation().z() = -1.0;
  EXPECT_THAT(DepthAligner(alignment).align(plane_of(40, 30, 900)).image.depth, Each(0));
}

TEST(DepthAligner, ErrorsSayWhatIsAllowed) {
  DepthAlignment alignment = {.depth = camera_of(40, 30), .colour = camera_of(40, 30)};
  EXPECT_THAT(
      error_text([&] { static_cast<void>(DepthAligner(alignment).align(plane_of(30, 40, 1))); }),
      HasSubstr("40x30, as the depth camera"));
  alignment.unit_m = 0.0;
  EXPECT_THAT(error_text([&] { DepthAligner aligner(alignment); }), HasSubstr("unit_m"));
  alignment = {.depth = {}, .colour = camera_of(40, 30)};
  EXPECT_THAT(error_text([&] { DepthAligner aligner(alignment); }), HasSubstr("width"));
}

}  // namespace
}  // namespace glidar
