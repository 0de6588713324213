// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/unambiguous_range.hpp>

#include "sensor/noise_stage.hpp"

#include <complex>
#include <numbers>

namespace glidar {
namespace {

using testing::expect_normal;
using testing::moments;
using testing::NoiseStage;

constexpr double kLight_m_per_s = 299792458.0;

/// Kinect v2's frequencies, and electrons that give an error of a few millimetres.
ContinuousWave kinect_v2() {
  ContinuousWave law;
  law.frequencies_hz = {80e6, 16e6, 120e6};
  law.electrons_at_full_scale = 20000.0;
  law.background_electrons = 5000.0;
  law.contrast = 0.6;
  return law;
}

TEST(ContinuousWave, UnambiguousRangesAreThoseOfTheFrequencies) {
  EXPECT_NEAR(unambiguous_range_m(std::vector{80e6}), 1.874, 5e-4);
  EXPECT_NEAR(unambiguous_range_m(std::vector{16e6}), 9.369, 5e-4);
  EXPECT_NEAR(unambiguous_range_m(std::vector{120e6}), 1.249, 5e-4);
  EXPECT_NEAR(unambiguous_range_m(std::vector{80e6, 16e6, 120e6}), 18.74, 5e-3);
}

TEST(ContinuousWave, HasTheSpreadOfLangeAndSeitz) {
  ContinuousWave law = kinect_v2();
  law.frequencies_hz = {16e6};
  NoiseStage stage(100, 1000, 4.0, 0.5);
  stage.apply({law});
  // sigma_z = c / (4 sqrt 2 pi f) sqrt(B + A) / (C A), A = 10000
  const double sigma_m = kLight_m_per_s / (4.0 * std::numbers::sqrt2 * std::numbers::pi * 16e6) *
                         std::sqrt(15000.0) / (0.6 * 10000.0);
  expect_normal(moments(stage.frame.range_m), 4.0, sigma_m);
  EXPECT_NEAR(stage.frame.sigma_m[0], sigma_m, 1e-6);
}

TEST(ContinuousWave, SeveralFrequenciesGiveTheMinimumVarianceMean) {
  NoiseStage stage(100, 1000, 11.7, 0.5);
  stage.apply({kinect_v2()});
  double inverse = 0.0;
  for (const double f : {80e6, 16e6, 120e6}) {
    const double sigma_m = kLight_m_per_s / (4.0 * std::numbers::sqrt2 * std::numbers::pi * f) *
                           std::sqrt(15000.0) / (0.6 * 10000.0);
    inverse += 1.0 / (sigma_m * sigma_m);
  }
  expect_normal(moments(stage.frame.range_m), 11.7, 1.0 / std::sqrt(inverse));
}

TEST(ContinuousWave, AnyNumberOfFrequenciesFindsTheRangeThatFitsThemAll) {
  ContinuousWave law = kinect_v2();
  law.electrons_at_full_scale = 1e12;  // negligible error
  const std::vector<std::vector<double>> choices = {
      {16e6},
      {80e6, 60e6},
      {80e6, 16e6, 120e6},
      {60e6, 50e6, 40e6, 30e6, 20e6},
      {10e6, 20e6, 30e6, 40e6, 50e6, 60e6, 70e6, 80e6}};
  for (const auto& frequencies_hz : choices) {
    law.frequencies_hz = frequencies_hz;
    const double limit_m = unambiguous_range_m(frequencies_hz);
    NoiseStage stage(1, 600, 1.0);
    std::vector<double> true_m;
    for (std::size_t i = 0; i < 600; ++i) {
      true_m.push_back(limit_m * (static_cast<double>(i) + 0.5) / 600.0);
      stage.frame.range_m[i] = true_m[i];
    }
    stage.apply({law});
    for (std::size_t i = 0; i < 600; ++i) {
      ASSERT_NEAR(stage.frame.range_m[i], true_m[i], 1e-4) << frequencies_hz.size() << " at " << i;
    }
  }
}

TEST(ContinuousWave, RangesBeyondTheUnambiguousRangeWrapAround) {
  ContinuousWave law = kinect_v2();
  law.electrons_at_full_scale = 1e12;  // negligible error
  NoiseStage stage(1, 4, 20.0);
  stage.apply({law});
  EXPECT_NEAR(stage.frame.range_m[0], 20.0 - 18.737028625, 1e-5);
  law.frequencies_hz = {80e6};
  stage.reset(20.0);
  stage.apply({law});
  EXPECT_NEAR(stage.frame.range_m[0], 20.0 - 10.0 * 1.8737028625, 1e-5);
}

TEST(ContinuousWave, WeakLightGivesTheWrongWrapOrNone) {
  ContinuousWave law = kinect_v2();
  law.electrons_at_full_scale = 300.0;
  law.background_electrons = 20000.0;
  law.max_phase_residual = 0.03;
  NoiseStage stage(100, 100, 6.0);
  stage.apply({law});
  double wrong = 0.0;
  double wrapped = 0.0;
  for (std::size_t i = 0; i < 10000; ++i) {
    if (stage.frame.status[i] == Status::phase_ambiguous) wrapped += 1.0;
    if (std::abs(stage.frame.range_m[i] - 6.0) > 0.6) wrong += 1.0;
  }
  EXPECT_GT(wrong, 100.0);
  EXPECT_GT(wrapped, 100.0);
}

TEST(ContinuousWave, AnEdgeHasThePhasorMeanOrIsInvalid) {
  // one frequency, two distances: the phase of the sum of the waves, and a test of its length
  ContinuousWave law = kinect_v2();
  law.frequencies_hz = {16e6};
  law.electrons_at_full_scale = 1e12;
  law.multipath_fraction = 0.8;
  NoiseStage stage(3, 5, 2.0);
  const auto set = [&](double near_m, double far_m) {
    stage.reset(near_m);
    for (std::size_t i = 0; i < 15; ++i) {
      if (i % 5 >= 3) stage.frame.range_m[i] = far_m;
    }
  };
  set(2.0, 3.0);
  stage.apply({law});
  // of the pixel in the middle: itself 0.2, five near neighbours and three far ones of 0.1 each
  const double k = 4.0 * std::numbers::pi * 16e6 / kLight_m_per_s;
  const std::complex<double> sum = std::polar(0.7, k * 2.0) + std::polar(0.3, k * 3.0);
  EXPECT_NEAR(stage.frame.range_m[7], std::arg(sum) / k, 1e-5);
  EXPECT_NEAR(stage.frame.range_m[6], 2.0, 1e-5);
  set(2.0, 2.0 + 9.368514 / 2.0);  // half a wave apart: 0.7 - 0.3 of 1
  stage.apply({law});
  EXPECT_EQ(stage.frame.status[7], Status::phase_ambiguous);
  EXPECT_EQ(stage.frame.status[6], Status::hit);
  law.min_coherence = 0.39;
  set(2.0, 2.0 + 9.368514 / 2.0);
  stage.apply({law});
  EXPECT_EQ(stage.frame.status[7], Status::hit);
}

}  // namespace
}  // namespace glidar
