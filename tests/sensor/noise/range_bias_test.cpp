// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/noise_stage.hpp"

#include <numbers>

namespace glidar {
namespace {

using testing::expect_normal;
using testing::moments;
using testing::NoiseStage;

TEST(RangeBias, IsTheSameForAllBeamsOfARingInAllFrames) {
  NoiseStage stage(4, 1000, 10.0);
  stage.apply({RangeBias{.offset_m = 0.1, .sigma_m = 0.01}});
  const std::vector<double> first = stage.frame.range_m;
  stage.reset(10.0);
  stage.frame.number = 5;
  stage.apply({RangeBias{.offset_m = 0.1, .sigma_m = 0.01}});
  EXPECT_EQ(stage.frame.range_m, first);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i], first[i / 1000 * 1000]);
  EXPECT_NE(first[0], first[1000]);
}

TEST(RangeBias, OfManyRingsIsNormalAndUsesTheKeyOfAllFrames) {
  NoiseStage stage(1, 60000, 10.0);
  for (std::uint32_t i = 0; i < 60000; ++i) {
    stage.beams.rings.push_back(static_cast<std::uint16_t>(i));
  }
  stage.frame.number = 3;
  stage.apply({RangeBias{.offset_m = 0.1, .sigma_m = 0.01}});
  expect_normal(moments(stage.frame.range_m), 10.1, 0.01);
  const RandomWords words = philox4x32({500, 32U << 24U, 0xFFFFFFFFU, 0}, {1, 0});
  const double normal = std::sqrt(-2.0 * std::log(uniform(words[0]))) *
                        std::cos(2.0 * std::numbers::pi * uniform(words[1]));
  EXPECT_NEAR(stage.frame.range_m[500], 10.1 + 0.01 * normal, 1e-12);
}

/// Means over independent processes of the products of values that lie `apart` frames.
double correlation(std::uint32_t frame, std::uint32_t apart, double frames_per_tau) {
  constexpr std::uint32_t kProcesses = 40000;
  double sum = 0.0;
  for (std::uint32_t k = 0; k < kProcesses; ++k) {
    const RngKey draw{.seed = 5, .beam = k};
    sum += drift_at(frame, frames_per_tau, draw) * drift_at(frame + apart, frames_per_tau, draw);
  }
  return sum / kProcesses;
}

TEST(RangeDrift, IsAGaussMarkovProcess) {
  constexpr double kFramesPerTau = 10.0;
  constexpr double kFourSigmas = 4.0 * 1.42 / 200.0;  // of a product's mean, 40000 processes
  for (const std::uint32_t frame : {0U, 63U, 77U, 1000000U}) {
    for (const std::uint32_t apart : {0U, 1U, 10U, 200U}) {
      EXPECT_NEAR(correlation(frame, apart, kFramesPerTau), std::exp(-1.0 * apart / kFramesPerTau),
                  kFourSigmas)
          << frame << " " << apart;
    }
  }
}

TEST(RangeDrift, HasTheSlopeOfTheProcessOverAMillionFrames) {
  // x_n+1 - p x_n is white with variance 1 - p^2: the property of the recursion, which is not used
  // here
  constexpr double kFramesPerTau = 50.0;
  const double p = std::exp(-1.0 / kFramesPerTau);
  std::vector<double> steps;
  double product = 0.0;
  double last = drift_at(0, kFramesPerTau, {});
  for (std::uint32_t frame = 1; frame <= 1000000; ++frame) {
    const double now = drift_at(frame, kFramesPerTau, {});
    steps.push_back((now - p * last) / std::sqrt(1.0 - p * p));
    if (frame > 1) product += steps[frame - 1] * steps[frame - 2];
    last = now;
  }
  expect_normal(moments(steps), 0.0, 1.0);
  EXPECT_LT(std::abs(product / 1e6), 4.0 / 1e3);
}

TEST(RangeDrift, IsIndependentOfTheOrderOfQueries) {
  const double later = drift_at(123456789, 1e5, {.seed = 3});
  drift_at(123456780, 1e5, {.seed = 3});
  EXPECT_EQ(drift_at(123456789, 1e5, {.seed = 3}), later);
  EXPECT_TRUE(std::isfinite(drift_at(0xFFFFFFFFU, 1e12, {.seed = 3})));
  EXPECT_TRUE(std::isfinite(drift_at(17, 1e-3, {.seed = 3})));
}

TEST(RangeDrift, MovesAllBeamsOfAFrameTogetherOrEachRing) {
  NoiseStage stage(2, 300, 10.0);
  stage.apply({RangeDrift{.sigma_m = 0.01, .tau_s = 5.0}});
  EXPECT_NE(stage.frame.range_m[0], 10.0);
  EXPECT_EQ(stage.frame.range_m[0], stage.frame.range_m[599]);
  EXPECT_EQ(stage.frame.range_m[0],
            10.0 + 0.01 * drift_at(0, 50.0, {.seed = 1, .purpose = Purpose::first_noise_step}));
  stage.reset(10.0);
  stage.apply({RangeDrift{.sigma_m = 0.01, .tau_s = 5.0, .per_ring = true}});
  EXPECT_EQ(stage.frame.range_m[0], stage.frame.range_m[299]);
  EXPECT_NE(stage.frame.range_m[0], stage.frame.range_m[300]);
}

}  // namespace
}  // namespace glidar
