// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/depth_filters.hpp>

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <depth_camera/librealsense_results.hpp>
#include <support/error_text.hpp>

#include <algorithm>

namespace glidar {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::vector<DepthFilter>& filters) {
  return error_text([&] { validate(filters); });
}

TEST(DepthFilter, RecommendedListsAreValid) {
  EXPECT_NO_THROW(validate(recommended_depth_filters(0.0)));
  EXPECT_NO_THROW(validate(recommended_depth_filters(0.05)));
  EXPECT_EQ(recommended_depth_filters(0.0).size(), 4U);
  EXPECT_EQ(recommended_depth_filters(0.05).size(), 6U);
}

TEST(DepthFilter, ErrorsNameTheFilterItsKeyAndWhatIsAllowed) {
  EXPECT_THAT(error_of({SpatialFilter{}, SpatialFilter{.alpha = 0.2}}),
              AllOf(HasSubstr("depth filter 2, spatial, alpha"), HasSubstr("0.25 to 1")));
  EXPECT_THAT(error_of({SpatialFilter{.delta = 51}}), HasSubstr("from 1 to 50"));
  EXPECT_THAT(error_of({SpatialFilter{.magnitude = 0}}), HasSubstr("from 1 to 5"));
  EXPECT_THAT(error_of({TemporalFilter{.alpha = 1.5}}), HasSubstr("temporal, alpha"));
  EXPECT_THAT(error_of({TemporalFilter{.persistence = 9}}), HasSubstr("from 0 to 8"));
  EXPECT_THAT(error_of({DecimationFilter{9}}), HasSubstr("from 1 to 8"));
  EXPECT_THAT(error_of({ToDisparity{}, ToDepth{}}), HasSubstr("to_disparity, baseline_m"));
  EXPECT_THAT(error_of({ThresholdFilter{2.0, 1.0}}), HasSubstr("max_m: is below min_m"));
}

TEST(DepthFilter, ListsKnowWhetherTheyHoldDepthsOrDisparities) {
  EXPECT_THAT(error_of({ToDisparity{0.05}}), HasSubstr("add to_depth"));
  EXPECT_THAT(error_of({ToDepth{}}), HasSubstr("add to_disparity before it"));
  EXPECT_THAT(error_of({ToDisparity{0.05}, DecimationFilter{}, ToDepth{}}),
              HasSubstr("depth filter 2, decimation"));
  EXPECT_THAT(error_of({ToDisparity{0.05}, ThresholdFilter{}, ToDepth{}}),
              HasSubstr("depth filter 2, threshold"));
  EXPECT_THAT(error_of({ToDisparity{0.05}, ToDisparity{0.05}, ToDepth{}}),
              HasSubstr("depth filter 2, to_disparity"));
}

using ::testing::Each;
using ::testing::ElementsAre;
using Depths = std::vector<std::uint16_t>;

DepthImage filter_once(const std::vector<DepthFilter>& filters, const DepthImage& image,
                       double focal_length_px = 400.0) {
  return DepthFilterChain(filters, {.focal_length_px = focal_length_px}).apply(image);
}

DepthImage constant_image(std::uint32_t width, std::uint32_t height, std::uint16_t depth) {
  return {width, height, Depths(std::size_t{width} * height, depth)};
}

TEST(DepthFilterChain, HasTheBytesOfLibrealsense) {
  for (const test::LibrealsenseResult& expected : test::librealsense_results()) {
    SCOPED_TRACE(expected.name);
    DepthFilterChain chain(expected.filters,
                           {.focal_length_px = test::kLibrealsenseFocalLength_px});
    DepthImage last;
    for (std::uint32_t k = 0; k < test::kLibrealsenseImages; ++k) {
      last = chain.apply(test::librealsense_input(k));
    }
    EXPECT_EQ(last.width, expected.last.width);
    EXPECT_EQ(last.height, expected.last.height);
    EXPECT_EQ(last.depth, expected.last.depth);
  }
}

TEST(DepthFilterChain, LeavesImagesAloneWithoutFilters) {
  const DepthImage image = test::librealsense_input(0);
  EXPECT_EQ(filter_once({}, image).depth, image.depth);
}

TEST(DepthFilterChain, DecimationKeepsTheMedianOrMeanOfTheDepthsOfABlock) {
  const DepthImage image = {8, 8, [] {
                              Depths depths(64, 0);
                              depths[0] = 10;
                              depths[1] = 40;
                              depths[8] = 30;
                              return depths;
                            }()};
  EXPECT_EQ(filter_once({DecimationFilter{2}}, image).depth[0], 30);
  EXPECT_EQ(filter_once({DecimationFilter{4}}, image).depth[0], 26);  // 80 / 3
  EXPECT_EQ(filter_once({DecimationFilter{2}}, image).depth[1], 0);
}

TEST(DepthFilterChain, DecimationPadsToMultiplesOfFour) {
  const DepthImage decimated = filter_once({DecimationFilter{3}}, constant_image(32, 16, 1000));
  EXPECT_EQ(decimated.width, 12U);  // 32 / 3 = 10
  EXPECT_EQ(decimated.height, 8U);  // 16 / 3 = 5
  EXPECT_EQ(std::count(decimated.depth.begin(), decimated.depth.end(), 1000), 50);
  EXPECT_EQ(std::count(decimated.depth.begin(), decimated.depth.end(), 0), 46);
}

TEST(DepthFilterChain, SmoothsBelowDeltaAndKeepsEdges) {
  const DepthImage noisy = {6, 1, {1000, 1010, 1000, 1200, 1210, 1200}};
  const Depths smooth = filter_once({SpatialFilter{}}, noisy).depth;
  EXPECT_LT(*std::max_element(smooth.begin(), smooth.begin() + 3), 1010);
  EXPECT_GT(*std::min_element(smooth.begin(), smooth.begin() + 3), 1000);
  EXPECT_GE(*std::min_element(smooth.begin() + 3, smooth.end()), 1200);
}

TEST(DepthFilterChain, ConstantDepthsSurviveTheWayThroughDisparities) {
  const std::vector<DepthFilter> filters = {ToDisparity{0.05}, SpatialFilter{}, TemporalFilter{},
                                            ToDepth{}};
  for (const std::uint16_t depth : Depths{1, 100, 2000, 30000, 65535}) {
    EXPECT_THAT(filter_once(filters, constant_image(5, 4, depth)).depth, Each(depth));
  }
}

TEST(DepthFilterChain, TemporalAverageIsExponential) {
  DepthFilterChain chain(std::vector<DepthFilter>{TemporalFilter{.alpha = 0.5}}, {});
  EXPECT_THAT(chain.apply(constant_image(1, 1, 1000)).depth, ElementsAre(1000));
  EXPECT_THAT(chain.apply(constant_image(1, 1, 1016)).depth, ElementsAre(1008));
  EXPECT_THAT(chain.apply(constant_image(1, 1, 1016)).depth, ElementsAre(1012));
  EXPECT_THAT(chain.apply(constant_image(1, 1, 1100)).depth, ElementsAre(1100));  // above delta
}

/// How many holes after `frames` frames with depth keep their depth.
int kept_holes(std::uint32_t persistence, int frames) {
  DepthFilterChain chain(std::vector<DepthFilter>{TemporalFilter{.persistence = persistence}}, {});
  for (int i = 0; i < frames; ++i) chain.apply(constant_image(1, 1, 500));
  int kept = 0;
  while (kept < 20 && chain.apply(constant_image(1, 1, 0)).depth[0] == 500) ++kept;
  return kept;
}

TEST(DepthFilterChain, PersistenceDecidesHowLongHolesKeepTheirDepth) {
  const std::vector<int> expected = {0, 1, 2, 3, 7, 2, 5, 8, 20};  // valid in ... of the last ...
  for (std::uint32_t mode = 0; mode < expected.size(); ++mode) {
    EXPECT_EQ(kept_holes(mode, 8), expected[mode]) << mode;
  }
  EXPECT_EQ(kept_holes(1, 7), 0);
  EXPECT_EQ(kept_holes(3, 1), 0);
}

TEST(DepthFilterChain, ResetAndANewSizeForgetAllImages) {
  const std::vector<DepthFilter> filters = {TemporalFilter{}};
  DepthFilterChain chain(filters, {});
  chain.apply(constant_image(2, 1, 1000));
  chain.reset();
  EXPECT_THAT(chain.apply(constant_image(2, 1, 1010)).depth, Each(1010));
  EXPECT_THAT(chain.apply(constant_image(1, 2, 1000)).depth, Each(1000));
  EXPECT_THAT(chain.apply(constant_image(1, 2, 1010)).depth, Each(1004));
}

TEST(DepthFilterChain, FilteredCameraHasTheFocalLengthOfTheSmallerImage) {
  const std::vector<DepthFilter> filters = {DecimationFilter{2}, DecimationFilter{3}};
  EXPECT_EQ(filtered_camera(filters, {.focal_length_px = 600.0}).focal_length_px, 100.0);
}

TEST(DepthFilterChain, ErrorsSayWhatIsMissing) {
  const std::vector<DepthFilter> disparity = {ToDisparity{0.05}, ToDepth{}};
  EXPECT_THAT(error_text([&] { DepthFilterChain(disparity, {}); }),
              HasSubstr("add focal_length_px"));
  EXPECT_THAT(error_text([&] { DepthFilterChain({}, {.unit_m = 0.0}); }), HasSubstr("unit_m"));
  EXPECT_THAT(error_text([&] {
                filter_once({}, {2, 2, {1, 2, 3}});
              }),
              HasSubstr("has 3 depths for 2x2 pixels"));
  EXPECT_THAT(error_text([&] { filter_once({}, {}); }), HasSubstr("0x0 pixels"));
  EXPECT_THAT(error_text([&] { filter_once({DecimationFilter{4}}, constant_image(3, 9, 1)); }),
              HasSubstr("less than one block"));
}

}  // namespace

}  // namespace glidar
