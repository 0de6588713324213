// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/fringes.hpp>

#include <glidar/core/error.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

using ::testing::HasSubstr;

constexpr FringePatterns kPatterns = {.width = 200, .height = 2, .period_px = 18.0};

/// The camera sees the projector's pixels one to one, and pixel 50 of row 1 not at all.
std::vector<GreyImage> see_patterns() {
  std::vector<GreyImage> images;
  for (std::size_t i = 0; i < image_count(kPatterns); ++i) {
    images.push_back(make_pattern(kPatterns, i));
    for (std::uint16_t& level : images.back().level)
      level = static_cast<std::uint16_t>(level * 200);
    images.back().max_level = 65535;
    images.back().level[200 + 50] = 7;
  }
  return images;
}

TEST(FringeTrace, AgreesWithTheDecoderInEveryPixel) {
  const std::vector<GreyImage> images = see_patterns();
  const DecodedFringes decoded = decode_fringes(images, kPatterns, {});
  for (std::uint32_t row = 0; row < 2; ++row) {
    for (std::uint32_t column = 0; column < 200; ++column) {
      const FringeTrace trace = explain_fringes(images, kPatterns, {}, {column, row});
      const std::size_t i = row * 200 + column;
      ASSERT_EQ(trace.status, decoded.status[i]);
      EXPECT_EQ(static_cast<float>(trace.phase_rad), decoded.phase_rad[i]);
      EXPECT_EQ(static_cast<float>(trace.modulation), decoded.modulation[i]);
      EXPECT_EQ(static_cast<float>(trace.mean_level), decoded.mean_level[i]);
      ASSERT_EQ(trace.tests.size(), 5U);
      const auto failed = std::find_if(trace.tests.begin(), trace.tests.end(),
                                       [](const FringeTest& test) { return !test.has_passed; });
      const bool is_valid = failed == trace.tests.end();
      EXPECT_EQ(is_valid ? FringeStatus::valid : failed->failure, trace.status);
      if (!is_valid) continue;
      EXPECT_EQ(static_cast<float>(trace.coordinate_px), decoded.coordinate_px[i]);
      EXPECT_EQ(trace.stripe, stripe_of(kPatterns, column));
      EXPECT_EQ(trace.period, std::floor((column + 0.5) / 18.0));
    }
  }
}

TEST(FringeTrace, HasALineForEachTest) {
  const std::vector<GreyImage> images = see_patterns();
  const std::string valid = format_fringe_trace(explain_fringes(images, kPatterns, {}, {50, 0}));
  EXPECT_THAT(valid, HasSubstr("pixel 50,0: valid\n"));
  EXPECT_THAT(valid, HasSubstr("stripe 5 of the code, period 2, coordinate 50."));
  EXPECT_THAT(valid, HasSubstr("  passed  outside: coordinate 50."));
  const std::string dark = format_fringe_trace(explain_fringes(images, kPatterns, {}, {50, 1}));
  EXPECT_THAT(dark, HasSubstr("pixel 50,1: low_modulation\nfringes: grey levels 7 7 7 7\n"));
  EXPECT_THAT(dark, HasSubstr("  failed  low_modulation: modulation 0.00 levels, needed: 4.00"));
}

TEST(FringeTrace, RefusesPixelsOutsideTheImages) {
  const std::vector<GreyImage> images = see_patterns();
  EXPECT_THAT(error_text([&] {
                explain_fringes(images, kPatterns, {}, {200, 0});
              }),
              HasSubstr("columns 0 to 199, rows 0 to 1"));
}

}  // namespace
}  // namespace glidar
