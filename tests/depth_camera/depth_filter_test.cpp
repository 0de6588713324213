// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/depth_filters.hpp>

#include <glidar/core/error.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace glidar
