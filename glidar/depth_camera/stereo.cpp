// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/text.hpp>
#include <glidar/depth_camera/stereo_matcher.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace glidar {

namespace {

constexpr WholeRule kDisparityRule = {0, 16384};
constexpr WholeRule kSearchRule = {2, 4096};
constexpr WholeRule kBoxRule = {1, 9};
constexpr WholeRule kPathRule = {4, 8};
constexpr WholeRule kUniquenessRule = {0, 99};
constexpr WholeRule kToleranceRule = {0, 4096};
constexpr WholeRule kGreyRule = {0, 65535};
constexpr WholeRule kDisparityStepRule = {0, 4096};
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

constexpr const char* kOptionPlace = "stereo option ";

void require_whole(const char* key, const WholeRule& rule, std::uint32_t value) {
  if (value >= rule.min && value <= rule.max) return;
  throw Error(
      {kOptionPlace + std::string(key), "is " + std::to_string(value),
       "a whole number from " + std::to_string(rule.min) + " to " + std::to_string(rule.max), ""});
}

void require_number_within(const char* key, const NumberRule& rule, double value) {
  if (accepts(rule, value)) return;
  throw Error({kOptionPlace + std::string(key), "is " + number_text(value), rule.allowed, ""});
}

std::int32_t box_area(const StereoOptions& options) {
  return static_cast<std::int32_t>(options.box_px * options.box_px);
}

void validate_combinations(const StereoOptions& options) {
  if (options.box_px % 2 == 0) {
    throw Error({kOptionPlace + std::string("box_px"), "is even: " + std::to_string(options.box_px),
                 "1, 3, 5, 7 or 9", "use a box with a centre"});
  }
  if (options.paths != 4 && options.paths != 8) {
    throw Error(
        {kOptionPlace + std::string("paths"), "is " + std::to_string(options.paths), "4 or 8", ""});
  }
  if (options.p2 < options.p1) {
    throw Error({kOptionPlace + std::string("p2"), "is below p1: " + number_text(options.p2),
                 "at least p1, " + number_text(options.p1), ""});
  }
  const std::int32_t greatest =
      static_cast<std::int32_t>(census_bits(options.census)) * box_area(options) +
      penalty_p2(options);
  if (greatest > kMaxPathCost) {
    throw Error({kOptionPlace + std::string("p2"),
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
                       kDisparityStepRule, options.steps_per_px);
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
  require_whole("steps_per_px", kDisparityStepRule, options.steps_per_px);
  require_number_within("p1", kPenaltyRule, options.p1);
  require_number_within("p2", kPenaltyRule, options.p2);
  require_number_within("a_factor", kFactorRule, options.a_factor);
  require_number_within("min_texture", kTextureRule, options.min_texture);
  validate_combinations(options);
}

namespace {

std::string size_text(const GreyImage& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

void require_image(const GreyImage& image, const char* where) {
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (pixels == 0) {
    throw Error(
        {where, "has no pixels: " + size_text(image), "at least one row and one column", ""});
  }
  if (image.level.size() == pixels) return;
  throw Error({where,
               "has " + std::to_string(image.level.size()) + " grey levels for " +
                   size_text(image) + " pixels",
               "one for each pixel", ""});
}

/// The sums without their padding and offset.
std::vector<std::uint16_t> copy_costs(const stereo::CostVolume& volume) {
  std::vector<std::uint16_t> cost(volume.width * volume.height * volume.disparities);
  auto to = cost.begin();
  for (std::size_t pixel = 0; pixel < volume.width * volume.height; ++pixel) {
    const std::int16_t* const from = volume.sum.data() + pixel * volume.lanes;
    for (std::size_t d = 0; d < volume.disparities; ++d) {
      *to++ = static_cast<std::uint16_t>(from[d] + stereo::kSumOffset);
    }
  }
  return cost;
}

}  // namespace

void require_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options) {
  require_image(left, "left image");
  require_image(right, "right image");
  if (left.width != right.width || left.height != right.height) {
    throw Error({"right image",
                 "has " + size_text(right) + " pixels, the left one " + size_text(left),
                 "images of equal size", "rectify both images to the same size"});
  }
  validate(options);
  const std::uint64_t reach = std::uint64_t{options.min_disparity_px} + options.disparities;
  if (reach > left.width) {
    throw Error(
        {"stereo option disparities",
         "min_disparity_px + disparities is " + std::to_string(reach) + ", wider than the image",
         "at most its " + std::to_string(left.width) + " columns", "search fewer disparities"});
  }
}

const char* to_string(StereoStatus status) {
  static constexpr const char* kNames[kStereoStatusCount] = {
      "valid", "border", "no_texture", "saturated", "out_of_range", "ambiguous", "left_right"};
  return kNames[static_cast<std::size_t>(status)];
}

struct StereoMatcher::Memory {
  stereo::CostVolume volume;
};

StereoMatcher::StereoMatcher(const StereoOptions& options)
    : options_(options), memory_(std::make_unique<Memory>()) {
  validate(options_);
}

StereoMatcher::~StereoMatcher() = default;
StereoMatcher::StereoMatcher(StereoMatcher&&) noexcept = default;
StereoMatcher& StereoMatcher::operator=(StereoMatcher&&) noexcept = default;

StereoMatch StereoMatcher::match(const GreyImage& left, const GreyImage& right,
                                 const StereoRun& run) {
  StereoMatch match = stereo::match_pair(left, right, options_, run, memory_->volume);
  if (run.keeps_costs) match.cost = copy_costs(memory_->volume);
  return match;
}

StereoMatch match_stereo(const GreyImage& left, const GreyImage& right,
                         const StereoOptions& options, const StereoRun& run) {
  return StereoMatcher(options).match(left, right, run);
}

namespace {

void validate_geometry(const StereoGeometry& geometry) {
  require_number(accepts(kAboveZero, geometry.focal_length_px), "stereo geometry, focal_length_px",
                 geometry.focal_length_px, kAboveZero.allowed);
  require_number(accepts(kAboveZero, geometry.baseline_m), "stereo geometry, baseline_m",
                 geometry.baseline_m, kAboveZero.allowed);
  require_number(accepts(kFinite, geometry.column_offset_px), "stereo geometry, column_offset_px",
                 geometry.column_offset_px, kFinite.allowed);
  require_number(accepts(kFromZero, geometry.depth_unit_m), "stereo geometry, depth_unit_m",
                 geometry.depth_unit_m, kFromZero.allowed);
}

}  // namespace

void describe(StereoGeometry& geometry, FieldVisitor& visitor) {
  visitor.number({"focal_length_px", "of both rectified cameras", kUnitPixel, kRequired},
                 kAboveZero, geometry.focal_length_px);
  visitor.number({"baseline_m", "distance of the cameras", kUnitMetre, kRequired}, kAboveZero,
                 geometry.baseline_m);
  visitor.number({"column_offset_px", "principal column of the right minus that of the left image",
                  kUnitPixel},
                 kFinite, geometry.column_offset_px);
  visitor.number({"depth_unit_m", "depths are multiples of this; 0: not rounded", kUnitMetre},
                 kFromZero, geometry.depth_unit_m);
}

std::vector<float> stereo_depth_m(const StereoMatch& match, const StereoGeometry& geometry) {
  validate_geometry(geometry);
  const double product = geometry.focal_length_px * geometry.baseline_m;
  std::vector<float> depth_m(match.disparity_px.size(), kNaNf);
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double disparity = match.disparity_px[i] + geometry.column_offset_px;
    if (!(disparity > 0.0)) continue;  // holes are NaN
    double z = product / disparity;
    if (geometry.depth_unit_m > 0.0) {
      z = std::floor(z / geometry.depth_unit_m + 0.5) * geometry.depth_unit_m;
    }
    depth_m[i] = static_cast<float>(z);
  }
  return depth_m;
}

namespace {

using stereo::PixelEvidence;

/// What makes the edge the cause of a later test's failure.
std::string border_text(const PixelEvidence& pixel, const StereoOptions& options) {
  if (!is_beside_border(pixel, options)) return "";
  return "; the next disparity on the right, " +
         number_text(static_cast<double>(pixel.next_disparity_px)) + ", needs a higher column";
}

std::vector<StereoTest> list_tests(const PixelEvidence& pixel, const StereoOptions& options) {
  const std::uint32_t disparity = options.min_disparity_px + pixel.winner;
  const double pixels = pixel.window_pixels;
  const std::uint32_t last = options.min_disparity_px + options.disparities - 1;
  return {
      {StereoStatus::border, is_inside(pixel, options),
       "column " + std::to_string(pixel.column) + ", needed: disparity " +
           std::to_string(disparity) + " + window " + std::to_string(window_radius_px(options)) +
           border_text(pixel, options)},
      {StereoStatus::no_texture, has_texture(pixel, options),
       "mean step of grey levels " + decimal_text(pixel.step_sum / pixels) +
           ", needed: " + decimal_text(options.min_texture)},
      {StereoStatus::saturated, is_unsaturated(pixel),
       decimal_text(100.0 * pixel.saturated_pixels / pixels) +
           " % of the window is saturated; above 50 % it is the cause of no texture or ambiguity"},
      {StereoStatus::out_of_range, is_in_range(pixel, options),
       "winner " + std::to_string(disparity) +
           ", search: " + std::to_string(options.min_disparity_px) + " to " + std::to_string(last)},
      {StereoStatus::ambiguous, is_unique(pixel),
       std::to_string(pixel.rivals) + " other disparities cost less than " +
           std::to_string(options.uniqueness_percent) + " % more"},
      {StereoStatus::left_right, is_consistent(pixel, options),
       "left " + std::to_string(disparity) + ", right " +
           std::to_string(options.min_disparity_px + pixel.right_winner) +
           ", allowed difference: " +
           (options.has_left_right_test ? std::to_string(options.left_right_px) : "any")}};
}

void copy_costs_of_pixel(const stereo::CostVolume& volume, StereoTrace& trace) {
  const std::size_t first = volume.offset(trace.row) + trace.column * volume.lanes;
  for (std::size_t i = first; i < first + volume.disparities; ++i) {
    trace.matching_cost.push_back(static_cast<std::uint16_t>(volume.cost.data()[i]));
    trace.summed_cost.push_back(
        static_cast<std::uint16_t>(volume.sum.data()[i] + stereo::kSumOffset));
  }
}

void set_disparity(const PixelEvidence& pixel, const StereoOptions& options, StereoTrace& trace) {
  if (is_in_range(pixel, options)) {
    const std::uint16_t* const at = trace.summed_cost.data() + pixel.winner;
    trace.offset_px = stereo::subpixel_offset(options.subpixel, at[-1], at[0], at[1]);
  }
  trace.corrected_offset_px = stereo::corrected_offset(trace.offset_px, options.a_factor);
  trace.disparity_px =
      stereo::rounded_disparity(trace.winner_px + trace.corrected_offset_px, options.steps_per_px);
}

std::string cost_lines(const StereoTrace& trace) {
  constexpr std::uint32_t kShown = 4;  // on both sides of the winner
  const std::uint32_t lane = trace.winner_px - trace.min_disparity_px;
  const auto count = static_cast<std::uint32_t>(trace.summed_cost.size());
  std::string text = "  disparity  matching cost  summed cost\n";
  for (std::uint32_t d = lane > kShown ? lane - kShown : 0; d < count && d <= lane + kShown; ++d) {
    const auto cell = [](std::uint32_t value, std::size_t width) {
      const std::string digits = std::to_string(value);
      return std::string(width > digits.size() ? width - digits.size() : 0, ' ') + digits;
    };
    text += cell(trace.min_disparity_px + d, 11) + cell(trace.matching_cost[d], 15) +
            cell(trace.summed_cost[d], 13) + (d == lane ? "  winner\n" : "\n");
  }
  return text;
}

}  // namespace

StereoTrace explain_stereo(const GreyImage& left, const GreyImage& right,
                           const StereoOptions& options, std::array<std::uint32_t, 2> column_row,
                           const StereoRun& run) {
  require_pair(left, right, options);
  const auto [column, row] = column_row;
  if (column >= left.width || row >= left.height) {
    throw Error({"pixel to explain",
                 std::to_string(column) + "," + std::to_string(row) + " is outside the image",
                 "columns 0 to " + std::to_string(left.width - 1) + ", rows 0 to " +
                     std::to_string(left.height - 1),
                 ""});
  }
  StereoRun kept = run;
  kept.keeps_costs = true;
  stereo::CostVolume volume;
  const StereoMatch match = stereo::match_pair(left, right, options, kept, volume);
  const std::size_t index = std::size_t{row} * left.width + column;
  const PixelEvidence pixel = stereo::gather_evidence(volume, match, left, options, index);
  StereoTrace trace = {.column = column,
                       .row = row,
                       .status = match.status[index],
                       .min_disparity_px = options.min_disparity_px,
                       .winner_px = options.min_disparity_px + pixel.winner,
                       .right_winner_px = options.min_disparity_px + pixel.right_winner};
  copy_costs_of_pixel(volume, trace);
  set_disparity(pixel, options, trace);
  trace.tests = list_tests(pixel, options);
  return trace;
}

std::string format_stereo_trace(const StereoTrace& trace) {
  std::string text = "pixel " + std::to_string(trace.column) + "," + std::to_string(trace.row) +
                     ": " + to_string(trace.status) + "\n";
  text += "disparity " + number_text(trace.disparity_px) + " px: winner " +
          std::to_string(trace.winner_px) + ", minimum of the curve " +
          decimal_text(trace.offset_px) + ", with a-factor " +
          decimal_text(trace.corrected_offset_px) + "\n";
  for (const StereoTest& test : trace.tests) {
    text += std::string(test.has_passed ? "  passed  " : "  failed  ") + to_string(test.failure) +
            ": " + test.finding + "\n";
  }
  return text + cost_lines(trace);
}

namespace {

constexpr std::uint32_t kPairWidth = 320;
constexpr std::uint32_t kPairHeight = 200;
constexpr std::int64_t kDiscColumn = 190;  // in the left image
constexpr std::int64_t kDiscRow = 90;
constexpr std::int64_t kDiscRadius = 50;

/// The grey level of a dot pattern: one pixel in four is bright, all have some noise.
std::uint16_t dots(std::int64_t column, std::uint32_t row, std::uint32_t layer) {
  PhiloxState words = {static_cast<std::uint32_t>(column + 1000), row, layer, 0};
  philox_rounds(words, 2026, 8);
  return static_cast<std::uint16_t>((words.c0 % 4 == 0 ? 120U : 30U) + words.c1 % 60U);
}

bool is_disc(std::int64_t column, std::int64_t row) {
  const std::int64_t dx = column - kDiscColumn;
  const std::int64_t dy = row - kDiscRow;
  return dx * dx + dy * dy <= kDiscRadius * kDiscRadius;
}

/// The plane at a column of the left image.
std::uint16_t plane_level(std::int64_t column, std::uint32_t row) {
  const bool is_patch_row = row >= 150 && row < 185;
  if (is_patch_row && column >= 90 && column < 140) return 40;
  if (is_patch_row && column >= 240 && column < 290) return 255;
  return dots(column, row, 0);
}

/// The scene at a column of the left image, for an eye in which the disc is displaced against the
/// plane by `displacement` columns to the left.
std::uint16_t level_at(std::int64_t column, std::uint32_t row, std::int64_t displacement) {
  const std::int64_t on_disc = column + displacement;
  return is_disc(on_disc, row) ? dots(on_disc, row, 1) : plane_level(column, row);
}

}  // namespace

StereoPair sample_stereo_pair() {
  StereoPair pair;
  for (GreyImage* image : {&pair.left, &pair.right}) {
    image->width = kPairWidth;
    image->height = kPairHeight;
    image->level.reserve(std::size_t{kPairWidth} * kPairHeight);
  }
  for (std::uint32_t row = 0; row < kPairHeight; ++row) {
    for (std::int64_t column = 0; column < kPairWidth; ++column) {
      pair.left.level.push_back(level_at(column, row, 0));
      pair.right.level.push_back(
          level_at(column + kSampleFar_px, row, std::int64_t{kSampleNear_px} - kSampleFar_px));
    }
  }
  return pair;
}

}  // namespace glidar
