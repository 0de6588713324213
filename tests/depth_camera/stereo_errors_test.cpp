// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/test_pairs.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace glidar {
namespace {

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

}  // namespace
}  // namespace glidar
