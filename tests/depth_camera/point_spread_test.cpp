// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/imager.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace glidar {
namespace {

TEST(PointSpread, HasSymmetricWeightsOfSumOne) {
  for (const std::uint32_t sub_rays : {1U, 2U, 3U, 5U}) {
    const std::vector<double> weights = point_spread_weights(sub_rays, 0.6);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-14);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      EXPECT_NEAR(weights[k], weights[weights.size() - 1 - k], 1e-16) << sub_rays << ' ' << k;
    }
  }
}

// Variances add: the Gaussian's, and that of the n rays of a pixel, (1 - 1/n²) / 12.
TEST(PointSpread, HasTheVarianceOfGaussianAndPixel) {
  constexpr std::uint32_t kRays = 4;
  const std::vector<double> weights = point_spread_weights(kRays, 0.6);
  const double middle = 0.5 * static_cast<double>(weights.size() - 1);
  double variance = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double offset_px = (static_cast<double>(k) - middle) / kRays;
    variance += weights[k] * offset_px * offset_px;
  }
  EXPECT_NEAR(variance, 0.36 + (1.0 - 1.0 / 16.0) / 12.0, 1e-3);
}

TEST(PointSpread, WithoutBlurIsTheMeanOfThePixelsRays) {
  const std::vector<double> weights = point_spread_weights(2, 0.0);
  std::vector<float> pixels;
  ThreadPool threads(1);
  const std::vector<float> rays = {1, 2, 3, 4, 5, 6, 7, 8};  // two pixels in a row
  average_rays(rays, 2, weights, {2, 1}, threads, pixels);
  EXPECT_EQ(pixels, (std::vector<float>{3.5F, 5.5F}));
}

TEST(PointSpread, KeepsAnEvenImageUpToItsEdgesForAnyThreads) {
  const std::vector<double> weights = point_spread_weights(3, 0.8);
  const std::vector<float> rays(30U * 3U * 20U * 3U, 0.7F);
  for (const unsigned count : {1U, 2U, 8U}) {
    ThreadPool threads(count);
    std::vector<float> pixels;
    average_rays(rays, 3, weights, {30, 20}, threads, pixels);
    ASSERT_EQ(pixels.size(), 600U);
    for (const float pixel : pixels) ASSERT_FLOAT_EQ(pixel, 0.7F);
  }
}

}  // namespace
}  // namespace glidar
