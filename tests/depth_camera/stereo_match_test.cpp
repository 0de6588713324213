// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo.hpp>

#include <depth_camera/brute_force.hpp>
#include <depth_camera/test_pairs.hpp>
#include <glidar/core/instruction_set.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

namespace glidar {
namespace {

using testing::BruteForce;
using testing::TestPair;

/// Every cost and status of a match as bytes, with NaN compared by bits.
std::string bytes_of(const StereoMatch& match) {
  std::string bytes(match.disparity_px.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), match.disparity_px.data(), bytes.size());
  for (const StereoStatus status : match.status) bytes += static_cast<char>(status);
  for (const std::uint16_t cost : match.cost) bytes += std::to_string(cost) + " ";
  return bytes;
}

void expect_brute_force_costs(const TestPair& pair, const StereoOptions& options) {
  const BruteForce expected(pair.left, pair.right, options);
  for (const InstructionSet set : usable_instruction_sets()) {
    const StereoMatch match = match_stereo(
        pair.left, pair.right, options, {.keeps_costs = true, .instruction_set = to_string(set)});
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < match.cost.size(); ++i) {
      const auto pixel = static_cast<int>(i / options.disparities);
      const auto width = static_cast<int>(pair.left.width);
      const auto d = static_cast<int>(i % options.disparities);
      wrong += match.cost[i] != expected.summed_cost(pixel % width, pixel / width, d) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U) << to_string(set) << " of " << match.cost.size();
  }
}

/// The share of pixels right of `column` with that disparity.
double exact_share(const StereoMatch& match, std::uint32_t column, float disparity_px) {
  std::size_t exact = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < match.status.size(); ++i) {
    if (i % match.width < column) continue;
    ++all;
    exact += match.disparity_px[i] == disparity_px ? 1 : 0;
  }
  return static_cast<double>(exact) / static_cast<double>(all);
}

std::size_t count_status(const StereoMatch& match, StereoStatus status) {
  return static_cast<std::size_t>(std::count(match.status.begin(), match.status.end(), status));
}

TEST(StereoCosts, EqualTheirDefinitionWithEightPaths) {
  const TestPair pair = testing::shifted_noise(40, 30, 5);
  expect_brute_force_costs(pair, {.disparities = 16});
}

TEST(StereoCosts, EqualTheirDefinitionWithFourPaths) {
  const TestPair pair = testing::shifted_noise(40, 30, 5);
  expect_brute_force_costs(pair, {.disparities = 16, .paths = 4});
}

TEST(StereoCosts, EqualTheirDefinitionForEveryCensusAndBox) {
  const TestPair pair = testing::shifted_noise(37, 19, 3);
  for (const StereoCensus census :
       {StereoCensus::window_9x9, StereoCensus::window_7x7, StereoCensus::symmetric_7x7}) {
    for (const std::uint32_t box_px : {1U, 3U, 9U}) {
      expect_brute_force_costs(pair, {.disparities = 13, .census = census, .box_px = box_px});
    }
  }
}

TEST(StereoCosts, EqualTheirDefinitionForSearchesOfAnyWidthAndStart) {
  const TestPair pair = testing::shifted_noise(80, 9, 3);
  for (const std::uint32_t disparities : {2U, 31U, 32U, 33U, 64U, 75U}) {
    expect_brute_force_costs(pair, {.min_disparity_px = 5, .disparities = disparities});
  }
}

TEST(StereoCosts, EqualTheirDefinitionInImagesSmallerThanTheWindow) {
  expect_brute_force_costs(testing::shifted_noise(3, 2, 1), {.disparities = 2, .box_px = 9});
  expect_brute_force_costs(testing::shifted_noise(2, 40, 0), {.disparities = 2});
}

TEST(StereoCosts, EqualTheirDefinitionAtTheGreatestPenalty) {
  const TestPair pair = testing::shifted_noise(40, 12, 5);
  StereoOptions options = {.disparities = 20, .box_px = 9, .p1 = 0.0, .p2 = 53.1};
  expect_brute_force_costs(pair, options);  // 48 x 81 + 4301 of 8191
  options.p1 = options.p2;
  expect_brute_force_costs(pair, options);
}

TEST(StereoMatch, IsTheSameForEveryNumberOfThreadsAndInstructionSet) {
  const TestPair pair = testing::step_pair(211, 67, 9, 30, 90, 150);
  const StereoOptions options = {.disparities = 45};
  const std::string expected =
      bytes_of(match_stereo(pair.left, pair.right, options, {.keeps_costs = true}));
  for (const unsigned threads : {1U, 2U, 8U}) {
    ThreadPool pool(threads);
    for (const InstructionSet set : usable_instruction_sets()) {
      StereoRun run = {.pool = &pool, .keeps_costs = true, .instruction_set = to_string(set)};
      EXPECT_EQ(bytes_of(match_stereo(pair.left, pair.right, options, run)), expected)
          << threads << " threads, " << to_string(set);
      run.keeps_costs = false;
      const std::string without = bytes_of(match_stereo(pair.left, pair.right, options, run));
      EXPECT_EQ(without, expected.substr(0, without.size()));
    }
  }
}

TEST(StereoMatch, IsTheSameFromAMatcherThatHasMatchedOtherPairs) {
  const StereoOptions options = {.disparities = 30};
  StereoMatcher matcher(options);
  const TestPair large = testing::shifted_noise(90, 50, 12);
  const TestPair small = testing::shifted_noise(60, 40, 7);
  (void)matcher.match(large.left, large.right);
  EXPECT_EQ(bytes_of(matcher.match(small.left, small.right)),
            bytes_of(match_stereo(small.left, small.right, options)));
}

TEST(StereoMatch, FindsShiftsOfWholePixelsExactly) {
  for (const std::uint32_t shift : {1U, 7U, 20U, 38U}) {
    const TestPair pair =
        testing::dot_pair(240, 120, [&](double) { return static_cast<double>(shift); });
    const StereoMatch match =
        match_stereo(pair.left, pair.right, {.disparities = 40, .subpixel = StereoSubpixel::none});
    EXPECT_GE(exact_share(match, shift + 5, static_cast<float>(shift)), 0.999) << shift;
  }
}

/// The greatest mean error over shifts of k / 16 px, pixels.
double pixel_locking(const StereoOptions& options) {
  double greatest = 0.0;
  for (int k = 0; k < 16; ++k) {
    const double shift = 20.0 + k / 16.0;
    const TestPair pair = testing::dot_pair(240, 120, [&](double) { return shift; });
    const StereoMatch match = match_stereo(pair.left, pair.right, options);
    double sum = 0.0;
    for (const float disparity : match.disparity_px) {
      if (!std::isnan(disparity)) sum += disparity - shift;
    }
    const double mean = sum / static_cast<double>(count_status(match, StereoStatus::valid));
    greatest = std::max(greatest, std::abs(mean));
  }
  return greatest;
}

TEST(StereoMatch, LocksToWholePixelsByLessThanATenthOfAPixel) {
  EXPECT_LE(pixel_locking({.disparities = 40}), 0.10);
}

TEST(StereoMatch, LocksByLessThanAThirtiethOfAPixelWithAFittedAFactor) {
  EXPECT_LE(pixel_locking({.disparities = 40, .a_factor = 0.12}), 0.03);
}

TEST(StereoMatch, HasABandWithoutDisparityLeftOfANearObject) {
  const std::uint32_t far_px = 10;
  const std::uint32_t near_px = 34;
  const TestPair pair = testing::step_pair(260, 80, far_px, near_px, 140, 200);
  const StereoMatch match = match_stereo(pair.left, pair.right, {.disparities = 48});
  double band = 0.0;
  for (std::size_t y = 10; y < 70; ++y) {
    for (std::size_t x = 100; x < 140; ++x) band += std::isnan(match.disparity_px[y * 260 + x]);
    for (std::size_t x = 206; x < 240; ++x) {
      EXPECT_EQ(std::lround(match.disparity_px[y * 260 + x]), far_px) << x << "," << y;
    }
  }
  EXPECT_NEAR(band / 60.0, near_px - far_px, 1.0);
}

TEST(StereoMatch, HasABorderOfTheDisparityPlusHalfAWindowOnTheLeft) {
  const TestPair pair = testing::shifted_noise(260, 60, 57);
  const StereoMatch match = match_stereo(pair.left, pair.right, {.disparities = 96});
  for (std::size_t y = 0; y < 60; ++y) {
    std::size_t x = 0;
    while (std::isnan(match.disparity_px[y * 260 + x])) ++x;
    EXPECT_GE(x, 57U + 3U);
    EXPECT_LE(x, 57U + 8U);
    EXPECT_EQ(match.status[y * 260 + 40], StereoStatus::border);
  }
}

TEST(StereoMatch, RoundsToTheStepsOfAPixel) {
  const TestPair pair = testing::dot_pair(120, 60, [](double row) { return 10.0 + row / 60.0; });
  for (const std::uint32_t steps : {1U, 8U, 32U}) {
    const StereoMatch match =
        match_stereo(pair.left, pair.right, {.disparities = 24, .steps_per_px = steps});
    ASSERT_GT(count_status(match, StereoStatus::valid), 1000U);
    for (const float disparity : match.disparity_px) {
      const double scaled = static_cast<double>(disparity) * steps;
      if (std::isnan(scaled)) continue;
      EXPECT_EQ(scaled, std::round(scaled));
    }
  }
}

TEST(StereoMatch, ReportsNoTextureInAFlatImage) {
  const GreyImage flat = testing::flat_image(60, 40, 100);
  const StereoMatch match = match_stereo(flat, flat, {.disparities = 16});
  EXPECT_EQ(count_status(match, StereoStatus::valid), 0U);
  EXPECT_EQ(match.status[20 * 60 + 50], StereoStatus::no_texture);
}

TEST(StereoMatch, ReportsSaturationWhereItHidesTheTexture) {
  const GreyImage white = testing::flat_image(60, 40, 255);
  EXPECT_EQ(match_stereo(white, white, {.disparities = 16}).status[20 * 60 + 50],
            StereoStatus::saturated);
  const GreyImage grey = testing::flat_image(60, 40, 200);
  const StereoOptions options = {.disparities = 16, .saturation_level = 200};
  EXPECT_EQ(match_stereo(grey, grey, options).status[20 * 60 + 50], StereoStatus::saturated);
}

TEST(StereoMatch, ReportsAmbiguityWhereNothingMatches) {
  const StereoMatch match = match_stereo(testing::noise_image(160, 60, 1),
                                         testing::noise_image(160, 60, 2), {.disparities = 40});
  EXPECT_GT(count_status(match, StereoStatus::ambiguous), 4800U);  // half of the pixels
  EXPECT_LT(count_status(match, StereoStatus::valid), 1920U);      // a fifth
}

TEST(StereoMatch, ReportsDisparitiesAtTheEndsOfTheSearchAsOutOfRange) {
  const TestPair pair = testing::shifted_noise(160, 40, 20);
  const StereoMatch below =
      match_stereo(pair.left, pair.right, {.min_disparity_px = 20, .disparities = 30});
  EXPECT_EQ(below.status[20 * 160 + 100], StereoStatus::out_of_range);
  const StereoMatch above = match_stereo(pair.left, pair.right, {.disparities = 21});
  EXPECT_EQ(above.status[20 * 160 + 100], StereoStatus::out_of_range);
  const StereoMatch inside = match_stereo(pair.left, pair.right, {.disparities = 22});
  EXPECT_NEAR(inside.disparity_px[20 * 160 + 100], 20.0, 0.1);
}

TEST(StereoMatch, ReportsOccludedPixelsAsALeftRightMismatch) {
  const TestPair pair = testing::step_pair(260, 80, 10, 34, 140, 200);
  const StereoOptions options = {.disparities = 48, .uniqueness_percent = 0};
  const StereoMatch match = match_stereo(pair.left, pair.right, options);
  EXPECT_EQ(match.status[40 * 260 + 130], StereoStatus::left_right);
  StereoOptions without = options;
  without.has_left_right_test = false;
  EXPECT_EQ(match_stereo(pair.left, pair.right, without).status[40 * 260 + 130],
            StereoStatus::valid);
}

TEST(StereoMatch, HasADisparityExactlyWhereTheStatusIsValid) {
  const TestPair pair = testing::step_pair(211, 67, 9, 30, 90, 150);
  const StereoMatch match = match_stereo(pair.left, pair.right, {.disparities = 45});
  for (std::size_t i = 0; i < match.status.size(); ++i) {
    EXPECT_EQ(std::isnan(match.disparity_px[i]), match.status[i] != StereoStatus::valid);
  }
}

TEST(StereoMatch, TakesGreyLevelsOf16Bits) {
  TestPair pair = testing::shifted_noise(120, 40, 11);
  for (GreyImage* image : {&pair.left, &pair.right}) {
    image->max_level = 65535;
    for (std::uint16_t& level : image->level) level = static_cast<std::uint16_t>(level * 257);
  }
  const StereoMatch match =
      match_stereo(pair.left, pair.right, {.disparities = 24, .subpixel = StereoSubpixel::none});
  EXPECT_GT(exact_share(match, 11 + 6, 11.0F), 0.99);
}

TEST(StereoMatch, ReportsProgressUpToOne) {
  const TestPair pair = testing::shifted_noise(60, 40, 7);
  std::vector<double> fractions;
  (void)match_stereo(pair.left, pair.right, {.disparities = 16},
                     {.progress = [&](double done) { fractions.push_back(done); }});
  ASSERT_GT(fractions.size(), 10U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

}  // namespace
}  // namespace glidar
