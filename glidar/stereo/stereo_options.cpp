// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/stereo_options.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>

#include <array>
#include <cmath>
#include <string>

namespace glidar {

namespace {

constexpr WholeRule kDisparityRule = {0, 16384};
constexpr WholeRule kSearchRule = {2, 4096};
constexpr WholeRule kBoxRule = {1, 9};
constexpr WholeRule kPathRule = {4, 8};
constexpr WholeRule kUniquenessRule = {0, 99};
constexpr WholeRule kToleranceRule = {0, 4096};
constexpr WholeRule kGreyRule = {0, 65535};
constexpr WholeRule kStepRule = {0, 4096};
constexpr NumberRule kPenaltyRule = {0.0, 1000.0, false, "a number from 0 to 1000"};
constexpr NumberRule kFactorRule = {-0.15, 0.15, false, "a number from -0.15 to 0.15"};
constexpr NumberRule kTextureRule = {0.0, 65535.0, false, "a number from 0 to 65535"};
/// 8 path costs of at most this, each a cost plus P2, fit into 16 bits.
constexpr std::int32_t kMaxPathCost = 8191;

constexpr std::array<Named<StereoCensus>, 3> kCensusNames = {
    {{"9x9", StereoCensus::window_9x9},
     {"7x7", StereoCensus::window_7x7},
     {"7x7-symmetric", StereoCensus::symmetric_7x7}}};
constexpr std::array<Named<StereoSubpixel>, 3> kSubpixelNames = {
    {{"v", StereoSubpixel::v_shape},
     {"parabola", StereoSubpixel::parabola},
     {"none", StereoSubpixel::none}}};

constexpr const char* kPlace = "stereo option ";

void require_whole(const char* key, const WholeRule& rule, std::uint32_t value) {
  if (value >= rule.min && value <= rule.max) return;
  throw Error(
      {kPlace + std::string(key), "is " + std::to_string(value),
       "a whole number from " + std::to_string(rule.min) + " to " + std::to_string(rule.max), ""});
}

void require_number_within(const char* key, const NumberRule& rule, double value) {
  if (accepts(rule, value)) return;
  throw Error({kPlace + std::string(key), "is " + number_text(value), rule.allowed, ""});
}

std::int32_t box_area(const StereoOptions& options) {
  return static_cast<std::int32_t>(options.box_px * options.box_px);
}

void validate_combinations(const StereoOptions& options) {
  if (options.box_px % 2 == 0) {
    throw Error({kPlace + std::string("box_px"), "is even: " + std::to_string(options.box_px),
                 "1, 3, 5, 7 or 9", "use a box with a centre"});
  }
  if (options.paths != 4 && options.paths != 8) {
    throw Error(
        {kPlace + std::string("paths"), "is " + std::to_string(options.paths), "4 or 8", ""});
  }
  if (options.p2 < options.p1) {
    throw Error({kPlace + std::string("p2"), "is below p1: " + number_text(options.p2),
                 "at least p1, " + number_text(options.p1), ""});
  }
  const std::int32_t greatest =
      static_cast<std::int32_t>(census_bits(options.census)) * box_area(options) +
      penalty_p2(options);
  if (greatest > kMaxPathCost) {
    throw Error({kPlace + std::string("p2"),
                 "census bits x box pixels + P2 is " + std::to_string(greatest),
                 "at most " + std::to_string(kMaxPathCost), "use a lower p2 or a smaller box"});
  }
}

}  // namespace

void describe(StereoOptions& options, FieldVisitor& visitor) {
  visitor.whole_number({"min_disparity_px", "least disparity searched", kUnitPixel}, kDisparityRule,
                       options.min_disparity_px);
  visitor.whole_number({"disparities", "number of disparities searched", kUnitPixel}, kSearchRule,
                       options.disparities);
  visit_choice(visitor, {"census", "pixels compared: each with the centre, or opposite ones"},
               kCensusNames, options.census);
  visitor.whole_number({"box_px", "odd side of the window that sums costs", kUnitPixel}, kBoxRule,
                       options.box_px);
  visitor.whole_number({"paths", "4: rows and columns; 8: diagonals too"}, kPathRule,
                       options.paths);
  visitor.number({"p1", "penalty of a step of 1 px, bits per pixel of the box"}, kPenaltyRule,
                 options.p1);
  visitor.number({"p2", "penalty of a larger step, bits per pixel of the box; at least `p1`"},
                 kPenaltyRule, options.p2);
  visit_choice(visitor, {"subpixel", "curve through three costs"}, kSubpixelNames,
               options.subpixel);
  visitor.number({"a_factor", "adds this times sin(2 pi fraction)", kUnitPixel}, kFactorRule,
                 options.a_factor);
  visitor.whole_number(
      {"uniqueness_percent", "how much more than the winner others must cost; 0: no test"},
      kUniquenessRule, options.uniqueness_percent);
  visitor.boolean({"has_left_right_test", "compare with the winner of the right view"},
                  options.has_left_right_test);
  visitor.whole_number({"left_right_px", "greatest difference of both views", kUnitPixel},
                       kToleranceRule, options.left_right_px);
  visitor.number({"min_texture", "mean step of grey levels between columns; 0: no test"},
                 kTextureRule, options.min_texture);
  visitor.whole_number(
      {"saturation_level", "grey level of saturated pixels; 0: the greatest of the pixel type"},
      kGreyRule, options.saturation_level);
  visitor.whole_number({"steps_per_px", "disparities are multiples of 1/this; 0: not rounded"},
                       kStepRule, options.steps_per_px);
}

std::uint32_t census_bits(StereoCensus census) {
  if (census == StereoCensus::window_9x9) return 80;
  return census == StereoCensus::window_7x7 ? 48 : 24;
}

std::uint32_t census_radius_px(StereoCensus census) {
  return census == StereoCensus::window_9x9 ? 4 : 3;
}

std::uint32_t window_radius_px(const StereoOptions& options) {
  return census_radius_px(options.census) + options.box_px / 2;
}

std::int32_t penalty_p1(const StereoOptions& options) {
  return static_cast<std::int32_t>(std::lround(options.p1 * box_area(options)));
}

std::int32_t penalty_p2(const StereoOptions& options) {
  return static_cast<std::int32_t>(std::lround(options.p2 * box_area(options)));
}

void validate(const StereoOptions& options) {
  require_whole("min_disparity_px", kDisparityRule, options.min_disparity_px);
  require_whole("disparities", kSearchRule, options.disparities);
  require_whole("box_px", kBoxRule, options.box_px);
  require_whole("uniqueness_percent", kUniquenessRule, options.uniqueness_percent);
  require_whole("left_right_px", kToleranceRule, options.left_right_px);
  require_whole("saturation_level", kGreyRule, options.saturation_level);
  require_whole("steps_per_px", kStepRule, options.steps_per_px);
  require_number_within("p1", kPenaltyRule, options.p1);
  require_number_within("p2", kPenaltyRule, options.p2);
  require_number_within("a_factor", kFactorRule, options.a_factor);
  require_number_within("min_texture", kTextureRule, options.min_texture);
  validate_combinations(options);
}

}  // namespace glidar
