// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/noise_stage.hpp"

#include <algorithm>
#include <numbers>
#include <random>

namespace glidar {
namespace {

using testing::expect_normal;
using testing::moments;
using testing::NoiseStage;

constexpr double kHalfLight_m_per_s = 0.5 * 299792458.0;

TEST(RangeGaussian, MillionBeamsHaveTheStatedMeanAndSpread) {
  NoiseStage stage(1000, 1000, 10.0);
  stage.apply({RangeGaussian{.sigma_m = 0.02, .sigma_per_m = 0.003}});
  expect_normal(moments(stage.frame.range_m), 10.0, 0.05);
  EXPECT_EQ(stage.frame.sigma_m[77], 0.05F);
}

TEST(RangeGaussian, PassesTheKolmogorovSmirnovTest) {
  NoiseStage stage(1000, 1000, 10.0);
  stage.apply({RangeGaussian{.sigma_m = 0.02}});
  std::vector<double>& sample = stage.frame.range_m;
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double theory = 0.5 * std::erfc(-(sample[i] - 10.0) / 0.02 / std::numbers::sqrt2);
    farthest = std::max(farthest, std::abs(theory - (static_cast<double>(i) + 0.5) / n));
  }
  constexpr double kOneInTenThousand = 2.23;  // quantile of Kolmogorov's distribution
  EXPECT_LT(farthest, kOneInTenThousand / std::sqrt(n));
}

TEST(RangeGaussian, EveryChannelIsNormal) {
  NoiseStage stage(64, 4096, 10.0);
  stage.apply({RangeGaussian{.sigma_m = 0.02}});
  constexpr int kBins = 8;  // octiles of the standard normal
  constexpr std::array<double, kBins - 1> kOctiles = {-1.15034938, -0.67448975, -0.31863936, 0.0,
                                                      0.31863936,  0.67448975,  1.15034938};
  for (std::size_t row = 0; row < 64; ++row) {
    std::array<double, kBins> found{};
    for (std::size_t col = 0; col < 4096; ++col) {
      const double x = (stage.frame.range_m[row * 4096 + col] - 10.0) / 0.02;
      const auto bin = std::upper_bound(kOctiles.begin(), kOctiles.end(), x) - kOctiles.begin();
      found[static_cast<std::size_t>(bin)] += 1.0;
    }
    double chi_square = 0.0;
    for (const double count : found) chi_square += (count - 512.0) * (count - 512.0) / 512.0;
    EXPECT_LT(chi_square, 31.0) << row;  // 7 degrees of freedom: one in 16000, of 64 rows
  }
}

TEST(RangeGaussian, UsesBoxMullerWithTheDocumentedCounter) {
  NoiseStage stage(1, 1001, 10.0);
  stage.frame.seed = 12345;
  stage.frame.number = 7;
  stage.apply({RangeQuantization{.step_m = 1e-3}, RangeGaussian{.sigma_m = 0.5}});
  // step 1: 32 + 1; beam 1000 is 232 = 3 * 64 + 40 of the run from 768 on: the last of four normals
  const RandomWords words = philox4x32({768 / 4 + 40, 33U << 24U, 7, 0}, {12345, 0});
  const double normal = std::sqrt(-2.0 * std::log(uniform(words[2]))) *
                        std::sin(2.0 * std::numbers::pi * uniform(words[3]));
  EXPECT_NEAR(stage.frame.range_m[1000], 10.0 + 0.5 * normal, 1e-12);
}

TEST(RangeGaussian, TheSurfaceScalesOnlyTheError) {
  NoiseStage plain(1, 300, 10.0);
  NoiseStage scaled(1, 300, 10.0);
  scaled.frame.ground_truth.noise_scale.assign(300, 3.0F);
  plain.apply({RangeGaussian{.sigma_m = 0.02}});
  scaled.apply({RangeGaussian{.sigma_m = 0.02}});
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_NEAR(scaled.frame.range_m[i] - 10.0, 3.0 * (plain.frame.range_m[i] - 10.0), 1e-14);
  }
  EXPECT_FLOAT_EQ(scaled.frame.sigma_m[0], 0.06F);
}

TEST(RangeSnr, GivesTheDataSheetsPrecisionOfTheOS1) {
  // data sheet: 1.5 cm at SNR 250, 3 cm at 100, 10 cm at 12; one parameter fits them within 28 %
  constexpr double kFit = 0.28;
  for (const auto& [snr, sigma_m] : {std::pair{250.0, 0.015}, {100.0, 0.03}, {12.0, 0.10}}) {
    NoiseStage stage(300, 1000, 10.0, snr / 250.0);
    stage.apply({RangeSnr{.k_m = 0.30, .snr_at_full_scale = 250.0}});
    const auto found = moments(stage.frame.range_m);
    expect_normal(found, 10.0, 0.30 / std::sqrt(snr));
    EXPECT_NEAR(found.sigma / sigma_m, 1.0, kFit) << snr;
  }
}

TEST(RangeSnr, HasAFloor) {
  NoiseStage stage(300, 1000, 10.0, 0.25);
  stage.apply({RangeSnr{.floor_m = 0.004, .k_m = 0.03, .snr_at_full_scale = 400.0}});
  expect_normal(moments(stage.frame.range_m), 10.0, 0.005);
}

TEST(RangeCrlb, AgreesWithTheSpreadOfTheBestEstimatorOfASampledPulse) {
  constexpr double kSigmaP_s = 2e-9;
  constexpr double kSample_s = 0.5e-9;
  constexpr double kNoise = 0.02;
  const RangeCrlb law{
      .pulse_fwhm_s = kSigmaP_s * 2.3548200450309493, .sample_s = kSample_s, .noise = kNoise};
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0.0, kNoise);
  std::vector<double> ranges_m;
  for (int trial = 0; trial < 4000; ++trial) {
    // one step of Newton's method from the true value: the maximum likelihood at high signal
    double up = 0.0;
    double down = 0.0;
    for (int k = -40; k <= 40; ++k) {
      const double t = k * kSample_s;
      const double pulse = std::exp(-t * t / (2.0 * kSigmaP_s * kSigmaP_s));
      const double slope = pulse * t / (kSigmaP_s * kSigmaP_s);  // by the time of arrival
      up += slope * noise(generator);
      down += slope * slope;
    }
    ranges_m.push_back(kHalfLight_m_per_s * up / down);
  }
  constexpr double kTenPercent = 0.1;
  EXPECT_NEAR(moments(ranges_m).sigma / pulse_sigma_m(law, 1.0), 1.0, kTenPercent);
  NoiseStage stage(300, 1000, 10.0, 0.5);
  stage.apply({law});
  expect_normal(moments(stage.frame.range_m), 10.0, pulse_sigma_m(law, 0.5));
}

TEST(RangeShotNoise, DecreasesWithTheRootOfThePhotonNumber) {
  const RangeShotNoise law{.pulse_fwhm_s = 5e-9, .photons_at_full_scale = 1000.0};
  std::vector<double> logs;
  for (const double intensity : {0.01, 0.1, 1.0}) {
    NoiseStage stage(300, 1000, 10.0, intensity);
    stage.apply({law});
    const auto found = moments(stage.frame.range_m);
    expect_normal(found, 10.0, photon_sigma_m(law, static_cast<float>(intensity)));
    logs.push_back(std::log10(found.sigma));
  }
  constexpr double kSlope = 0.01;
  EXPECT_NEAR(logs[1] - logs[0], -0.5, kSlope);
  EXPECT_NEAR(logs[2] - logs[1], -0.5, kSlope);
  // the mean of N arrival times of a pulse of standard deviation 5 ns / 2.3548
  EXPECT_NEAR(photon_sigma_m(law, 1.0), 0.149896229 * 5.0 / 2.35482 / std::sqrt(1000.0), 1e-7);
}

TEST(RangeUniform, HasTheStatedDistributions) {
  NoiseStage stage(1000, 1000, 10.0);
  stage.apply({RangeUniform{.additive_m = 0.3}});
  auto found = moments(stage.frame.range_m);
  EXPECT_NEAR(found.sigma, 0.3 / std::sqrt(3.0), 5e-4);
  EXPECT_LE(*std::max_element(stage.frame.range_m.begin(), stage.frame.range_m.end()), 10.3);
  EXPECT_GE(*std::min_element(stage.frame.range_m.begin(), stage.frame.range_m.end()), 9.7);
  stage.reset(10.0);
  stage.apply(
      {RangeUniform{.multiplicative = 0.01, .distribution = RangeUniform::Distribution::normal}});
  expect_normal(moments(stage.frame.range_m), 10.0, 0.1);
}

TEST(RangeQuantization, RoundsToMultiplesOfTheStep) {
  NoiseStage stage(100, 1000, 10.0);
  stage.beams.range_offset_m = 0.015;
  stage.apply({RangeGaussian{.sigma_m = 0.05}, RangeQuantization{.step_m = 0.002}});
  for (const double range_m : stage.frame.range_m) {
    const double steps = (range_m + 0.015) / 0.002;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
  expect_normal(moments(stage.frame.range_m), 10.0, std::hypot(0.05, 0.002 / std::sqrt(12.0)));
}

TEST(Noise, VariancesOfStepsAddUp) {
  NoiseStage stage(1, 10, 10.0);
  stage.apply({RangeGaussian{.sigma_m = 0.03}, RangeGaussian{.sigma_m = 0.04}});
  EXPECT_FLOAT_EQ(stage.frame.sigma_m[3], 0.05F);
}

TEST(Noise, MissingReturnsStayMissing) {
  NoiseStage stage(1, 10, 10.0);
  stage.lose_beam(4);
  stage.apply({RangeGaussian{.sigma_m = 0.03}, RangeBias{.offset_m = 1.0},
               RangeQuantization{.step_m = 0.01}, IntensityGaussian{.sigma = 0.1}});
  EXPECT_TRUE(std::isnan(stage.frame.range_m[4]));
  EXPECT_EQ(stage.frame.status[4], Status::miss);
  EXPECT_EQ(stage.frame.sigma_m[4], 0.0F);
  EXPECT_EQ(stage.frame.intensity[4], 0.0F);
}

TEST(Noise, NonPositiveRangesAreTooNear) {
  NoiseStage stage(1, 10, 0.5);
  stage.apply({RangeBias{.offset_m = -0.6}});
  EXPECT_EQ(stage.frame.status[0], Status::too_near);
  EXPECT_TRUE(std::isnan(stage.frame.range_m[0]));
  EXPECT_EQ(stage.frame.intensity[0], 0.0F);
}

TEST(Noise, WithoutStepsThereIsNoSigma) {
  NoiseStage stage(1, 10, 0.5);
  stage.apply({});
  EXPECT_TRUE(stage.frame.sigma_m.empty());
  EXPECT_EQ(stage.frame.range_m[0], 0.5);
}

}  // namespace
}  // namespace glidar
