// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo.hpp>

#include <glidar/math/constants.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

StereoMatch match_with(std::vector<float> disparity_px) {
  StereoMatch match;
  match.width = static_cast<std::uint32_t>(disparity_px.size());
  match.height = 1;
  match.disparity_px = std::move(disparity_px);
  return match;
}

TEST(StereoDepth, IsFocalLengthTimesBaselineOverDisparity) {
  const auto depth =
      stereo_depth_m(match_with({64.0F, 10.5F, kNaNf}),
                     {.focal_length_px = 400.0, .baseline_m = 0.05, .depth_unit_m = 0.0});
  EXPECT_EQ(depth[0], 0.3125F);
  EXPECT_FLOAT_EQ(depth[1], 20.0F / 10.5F);
  EXPECT_TRUE(std::isnan(depth[2]));
}

TEST(StereoDepth, IsAMultipleOfTheCamerasUnit) {
  const auto depth =
      stereo_depth_m(match_with({64.0F}), {.focal_length_px = 400.0, .baseline_m = 0.05});
  EXPECT_FLOAT_EQ(depth[0], 0.313F);
}

TEST(StereoDepth, AddsTheOffsetOfThePrincipalColumns) {
  const auto depth = stereo_depth_m(
      match_with({30.0F, -20.0F}),
      {.focal_length_px = 400.0, .baseline_m = 0.1, .column_offset_px = 10.0, .depth_unit_m = 0.0});
  EXPECT_EQ(depth[0], 1.0F);
  EXPECT_TRUE(std::isnan(depth[1]));
}

TEST(StereoDepth, RefusesGeometryThatIsNotAllowed) {
  const auto error = [](const StereoGeometry& geometry) {
    return error_text([&] { (void)stereo_depth_m(match_with({1.0F}), geometry); });
  };
  EXPECT_THAT(error({.focal_length_px = 0.0, .baseline_m = 0.1}),
              ::testing::HasSubstr("focal_length_px: "));
  EXPECT_THAT(error({.focal_length_px = 400.0, .baseline_m = kNaN}),
              ::testing::HasSubstr("baseline_m: "));
}

}  // namespace
}  // namespace glidar
