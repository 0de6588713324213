// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/noise_text.hpp>

#include <gtest/gtest.h>

namespace glidar {
namespace {

TEST(NoiseText, IsTheNameAndNumbersOfASensorFile) {
  EXPECT_EQ(noise_text(RangeGaussian{.sigma_m = 0.03}),
            "range_gaussian sigma_m 0.03, sigma_per_m 0.0");
  EXPECT_EQ(noise_text(Dropout{.probability = 0.25, .by_range_m = {{1.0, 0.5}}}),
            "dropout probability 0.25, by_range_m [[1.0,0.5]], by_incidence_deg []");
  EXPECT_EQ(noise_text(IntensityScale{}).substr(0, 16), "intensity_scale ");
}

}  // namespace
}  // namespace glidar
