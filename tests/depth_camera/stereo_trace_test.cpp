// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo.hpp>

#include <depth_camera/brute_force.hpp>
#include <depth_camera/test_pairs.hpp>
#include <glidar/depth_camera/stereo_matcher.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace glidar {
namespace {

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
