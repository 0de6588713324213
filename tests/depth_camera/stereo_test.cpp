// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo.hpp>

#include <glidar/depth_camera/stereo_matcher.hpp>
#include <glidar/math/constants.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <depth_camera/brute_force.hpp>
#include <depth_camera/test_pairs.hpp>
#include <support/error_text.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

using testing::flat_image;
using ::testing::HasSubstr;

std::string match_error(const GreyImage& left, const GreyImage& right,
                        const StereoOptions& options = {.disparities = 16}) {
  return error_text([&] { (void)match_stereo(left, right, options); });
}

std::string option_error(const StereoOptions& options) {
  const GreyImage image = flat_image(64, 20, 0);
  return match_error(image, image, options);
}

TEST(StereoErrors, NameBothSizesOfImagesThatDiffer) {
  EXPECT_THAT(match_error(flat_image(40, 30, 0), flat_image(41, 30, 0)),
              HasSubstr("right image: has 41x30 pixels, the left one 40x30"));
}

TEST(StereoErrors, RefuseImagesWithoutPixels) {
  EXPECT_THAT(match_error(flat_image(0, 0, 0), flat_image(0, 0, 0)),
              HasSubstr("left image: has no pixels: 0x0"));
}

TEST(StereoErrors, RefuseGreyLevelsThatDoNotFillTheImage) {
  GreyImage broken = flat_image(40, 30, 0);
  broken.level.pop_back();
  EXPECT_THAT(match_error(flat_image(40, 30, 0), broken),
              HasSubstr("right image: has 1199 grey levels for 40x30 pixels"));
}

TEST(StereoErrors, RefuseSearchesWiderThanTheImage) {
  const GreyImage dot = flat_image(1, 1, 0);
  EXPECT_THAT(match_error(dot, dot), HasSubstr("wider than the image; allowed: at most its 1 col"));
  EXPECT_THAT(option_error({.min_disparity_px = 60, .disparities = 5}),
              HasSubstr("min_disparity_px + disparities is 65"));
}

TEST(StereoErrors, RefusePairsTooLargeForMemory) {
  const GreyImage vast = flat_image(16384, 2048, 0);
  EXPECT_THAT(match_error(vast, vast, {.disparities = 64}), HasSubstr("at most 1073741824"));
}

TEST(StereoErrors, NameTheOptionThatIsNotAllowed) {
  EXPECT_THAT(option_error({.disparities = 1}),
              HasSubstr("stereo option disparities: is 1; allowed: a whole number from 2 to 4096"));
  EXPECT_THAT(option_error({.disparities = 16, .box_px = 4}), HasSubstr("box_px: is even: 4"));
  EXPECT_THAT(option_error({.disparities = 16, .box_px = 11}), HasSubstr("box_px: is 11"));
  EXPECT_THAT(option_error({.disparities = 16, .paths = 5}), HasSubstr("paths: is 5"));
  EXPECT_THAT(option_error({.disparities = 16, .p1 = 5.0, .p2 = 4.0}),
              HasSubstr("p2: is below p1: 4"));
  EXPECT_THAT(option_error({.disparities = 16, .p2 = 900.0}), HasSubstr("at most 8191"));
  EXPECT_THAT(option_error({.disparities = 16, .a_factor = 0.5}), HasSubstr("a_factor: is 0.5"));
  EXPECT_THAT(option_error({.disparities = 16, .uniqueness_percent = 100}),
              HasSubstr("uniqueness_percent: is 100"));
}

TEST(StereoErrors, RefuseNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(option_error({.disparities = 16, .p1 = nan}), HasSubstr("p1: is nan"));
  EXPECT_THAT(option_error({.disparities = 16, .p2 = nan}), HasSubstr("p2: is nan"));
  EXPECT_THAT(option_error({.disparities = 16, .a_factor = nan}), HasSubstr("a_factor: is nan"));
  EXPECT_THAT(option_error({.disparities = 16, .min_texture = nan}),
              HasSubstr("min_texture: is nan"));
}

TEST(StereoErrors, RefuseInstructionSetsThatTheProcessorLacks) {
  const GreyImage image = flat_image(64, 20, 0);
  EXPECT_THAT(error_text([&] {
                (void)match_stereo(image, image, {.disparities = 16}, {.instruction_set = "sse9"});
              }),
              HasSubstr("no kernel 'sse9'"));
}

TEST(StereoErrors, RefuseToExplainPixelsOutsideTheImage) {
  const GreyImage image = flat_image(64, 20, 0);
  EXPECT_THAT(error_text([&] {
                (void)explain_stereo(image, image, {.disparities = 16}, {64, 3});
              }),
              HasSubstr("64,3 is outside the image; allowed: columns 0 to 63, rows 0 to 19"));
}

using testing::BruteForce;
using testing::TestPair;

TEST(StereoTrace, HasTheCostsOfTheDefinition) {
  const TestPair pair = testing::shifted_noise(40, 30, 5);
  const StereoOptions options = {.disparities = 16};
  const BruteForce expected(pair.left, pair.right, options);
  const StereoTrace trace = explain_stereo(pair.left, pair.right, options, {31, 12});
  ASSERT_EQ(trace.matching_cost.size(), 16U);
  ASSERT_EQ(trace.summed_cost.size(), 16U);
  for (int d = 0; d < 16; ++d) {
    EXPECT_EQ(trace.matching_cost[static_cast<std::size_t>(d)], expected.matching_cost(31, 12, d));
    EXPECT_EQ(trace.summed_cost[static_cast<std::size_t>(d)], expected.summed_cost(31, 12, d));
  }
}

TEST(StereoTrace, HasTheEvidenceThatLedToTheStatusOfEveryPixel) {
  const TestPair pair = testing::step_pair(120, 30, 5, 20, 60, 90);
  const StereoOptions options = {.disparities = 30};
  stereo::CostVolume volume;
  const StereoMatch match =
      stereo::match_pair(pair.left, pair.right, options, {.keeps_costs = true}, volume);
  std::size_t different = 0;
  for (std::uint32_t i = 0; i < 120 * 30; ++i) {
    const auto pixel = stereo::gather_evidence(volume, match, pair.left, options, i);
    different += classify(pixel, options) != match.status[i] ? 1 : 0;
  }
  EXPECT_EQ(different, 0U);
}

TEST(StereoTrace, HasTheDisparityOfTheMatch) {
  const TestPair pair = testing::dot_pair(120, 40, [](double) { return 9.4; });
  const StereoOptions options = {.disparities = 24, .a_factor = 0.04};
  const StereoMatch match = match_stereo(pair.left, pair.right, options);
  const StereoTrace trace = explain_stereo(pair.left, pair.right, options, {70, 20});
  EXPECT_EQ(trace.status, StereoStatus::valid);
  EXPECT_EQ(static_cast<float>(trace.disparity_px), match.disparity_px[20 * 120 + 70]);
  EXPECT_NE(trace.offset_px, trace.corrected_offset_px);
}

TEST(StereoTrace, ListsTheFailedTestOfAPixelWithoutDisparity) {
  const TestPair pair = testing::step_pair(260, 80, 10, 34, 140, 200);
  const StereoOptions options = {.disparities = 48, .uniqueness_percent = 0};
  const StereoTrace trace = explain_stereo(pair.left, pair.right, options, {130, 40});
  ASSERT_EQ(trace.tests.size(), 6U);
  EXPECT_EQ(trace.status, StereoStatus::left_right);
  EXPECT_EQ(trace.tests.back().failure, StereoStatus::left_right);
  EXPECT_FALSE(trace.tests.back().has_passed);
  EXPECT_THAT(format_stereo_trace(trace), ::testing::HasSubstr("failed  left_right: left "));
}

TEST(StereoTrace, TextMarksTheWinner) {
  const TestPair pair = testing::shifted_noise(60, 30, 7);
  const StereoOptions options = {.disparities = 16, .subpixel = StereoSubpixel::none};
  const StereoTrace trace = explain_stereo(pair.left, pair.right, options, {40, 15});
  const std::string text = format_stereo_trace(trace);
  EXPECT_THAT(text, ::testing::HasSubstr("pixel 40,15: valid\ndisparity 7 px: winner 7"));
  EXPECT_THAT(text, ::testing::ContainsRegex(" 7 +0 +[0-9]+  winner"));
}

}  // namespace

}  // namespace glidar
