// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/sensor/lidar/echo.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

constexpr double kSigma_m = 0.3;

WaveformBuffer echoes_of(const std::vector<std::pair<double, double>>& paths) {
  WaveformBuffer work;
  std::uint32_t source = 0;
  for (const auto& [range_m, signal] : paths) {
    work.add({range_m, signal, source++, ReturnSource::surface});
  }
  detect_peaks(kSigma_m, kSigma_m, work);
  return work;
}

// Two echoes if and only if they are more than c FWHM / 2.355 apart (5 %).
TEST(DetectPeaks, SeparatesTwoPlanesBeyondTwoSigmas) {
  constexpr double kTolerance = 0.05;
  const double limit_m = 2.0 * kSigma_m;
  for (double apart_m = 0.05; apart_m < 3.0; apart_m += 0.01) {
    const WaveformBuffer work = echoes_of({{20.0, 1.0}, {20.0 + apart_m, 1.0}});
    if (apart_m > (1.0 + kTolerance) * limit_m) {
      ASSERT_EQ(work.echoes, 2U) << apart_m;
      EXPECT_NEAR(work.echo[0].range_m, 20.0, 1e-12);
      EXPECT_NEAR(work.echo[1].range_m, 20.0 + apart_m, 1e-12);
    }
    if (apart_m < (1.0 - kTolerance) * limit_m) {
      ASSERT_EQ(work.echoes, 1U) << apart_m;
    }
  }
}

TEST(DetectPeaks, PutsAnUnresolvedEchoAtTheWeightedMean) {
  for (const double share : {0.1, 0.3, 0.5, 0.8}) {
    const double apart_m = 1.7 * kSigma_m;
    const WaveformBuffer work = echoes_of({{20.0, 1.0 - share}, {20.0 + apart_m, share}});
    ASSERT_EQ(work.echoes, 1U);
    EXPECT_NEAR(work.echo[0].range_m, 20.0 + share * apart_m, 0.01 * apart_m);
  }
}

TEST(DetectPeaks, HasTheHeightOfTheSum) {
  const WaveformBuffer one = echoes_of({{20.0, 2.0}, {20.0, 3.0}});
  EXPECT_NEAR(one.echo[0].signal, 5.0, 1e-12);
  EXPECT_NEAR(one.echo[0].sigma_m, kSigma_m, 1e-12);

  const double off = 0.25;  // of sigma, to both sides: the peak is in the middle
  const WaveformBuffer two = echoes_of({{20.0, 1.0}, {20.0 + 2.0 * off * kSigma_m, 1.0}});
  EXPECT_NEAR(two.echo[0].signal, 2.0 * std::exp(-0.5 * off * off), 1e-12);
  EXPECT_NEAR(two.echo[0].sigma_m, kSigma_m * std::hypot(1.0, off), 1e-12);

  const double wide = 1.6 * kSigma_m;  // found by sampling
  const WaveformBuffer flat = echoes_of({{20.0, 1.0}, {20.0 + wide, 1.0}});
  EXPECT_NEAR(flat.echo[0].signal, 2.0 * std::exp(-0.5 * 0.8 * 0.8), 1e-5);
}

TEST(DetectPeaks, MatchesAFineSamplingOfTheWaveform) {
  const std::vector<std::pair<double, double>> paths = {
      {10.0, 1.0}, {10.5, 0.4}, {11.1, 2.0}, {11.3, 0.5}, {13.0, 0.7}, {30.0, 1.0}, {30.9, 1.1}};
  const auto waveform = [&](double at) {
    double sum = 0.0;
    for (const auto& [range_m, signal] : paths) {
      sum += signal * std::exp(-0.5 * std::pow((at - range_m) / kSigma_m, 2.0));
    }
    return sum;
  };
  std::vector<double> peaks;
  constexpr double kStep = 1e-4;
  for (double at = 9.0; at < 32.0; at += kStep) {
    if (waveform(at) > waveform(at - kStep) && waveform(at) >= waveform(at + kStep))
      peaks.push_back(waveform(at));
  }
  const WaveformBuffer work = echoes_of(paths);
  ASSERT_EQ(work.echoes, peaks.size());
  for (std::size_t i = 0; i < peaks.size(); ++i) EXPECT_NEAR(work.echo[i].signal, peaks[i], 1e-4);
}

TEST(DetectPeaks, MarksEchoesOfSeveralSurfacesAsMixed) {
  const auto is_mixed = [](const std::vector<EchoContribution>& paths) {
    WaveformBuffer work;
    for (const EchoContribution& path : paths) work.add(path);
    detect_peaks(kSigma_m, kSigma_m, work);
    return work.echo[0].is_mixed;
  };
  const EchoContribution first{20.0, 1.0, 0, ReturnSource::surface, 0};
  EXPECT_FALSE(is_mixed({first, {20.25, 1.0, 1, ReturnSource::surface, 0}}));
  EXPECT_TRUE(is_mixed({first, {20.001, 1.0, 1, ReturnSource::surface, 1}}));
  EXPECT_FALSE(is_mixed({first, {25.0, 1.0, 1, ReturnSource::surface, 1}})) << "two echoes";
  EXPECT_FALSE(is_mixed({first, {20.1, 1.0, kInvalidId, ReturnSource::fog, 0}}))
      << "air is no surface";
  EXPECT_TRUE(is_mixed({first, {20.1, 1.0, 0, ReturnSource::ghost, kGhostSurface}}));
  EXPECT_FALSE(is_mixed({first, {20.1, 0.0, 1, ReturnSource::surface, 1}}))
      << "black surface behind";
  EXPECT_FALSE(is_mixed({{20.1, 0.0, 1, ReturnSource::surface, 1}, first}))
      << "black surface in front";
  EXPECT_FALSE(is_mixed({first, {20.1, 9e-4, 1, ReturnSource::surface, 1}}));
  EXPECT_TRUE(is_mixed({first, {20.1, 1.1e-3, 1, ReturnSource::surface, 1}}));
  const EchoContribution faint{20.1, 7e-4, 1, ReturnSource::surface, 1};
  EXPECT_TRUE(is_mixed({first, faint, faint})) << "two sub-rays on one surface";
}

TEST(DetectPeaks, ReportsTheStrongestContribution) {
  const WaveformBuffer work = echoes_of({{20.1, 1.0}, {20.0, 3.0}, {25.0, 1.0}});
  ASSERT_EQ(work.echoes, 2U);
  EXPECT_EQ(work.path[work.echo[0].strongest].source, 1U);
  EXPECT_EQ(work.path[work.echo[1].strongest].source, 2U);
}

TEST(DetectPeaks, IsIndependentOfTheOrderOfNearContributions) {
  const WaveformBuffer up = echoes_of({{20.0, 1.0}, {20.05, 3.0}, {20.1, 3.0}, {20.2, 2.0}});
  const WaveformBuffer mixed = echoes_of({{20.2, 2.0}, {20.1, 3.0}, {20.0, 1.0}, {20.05, 3.0}});
  ASSERT_EQ(up.echoes, 1U);
  ASSERT_EQ(mixed.echoes, 1U);
  EXPECT_NEAR(mixed.echo[0].range_m, up.echo[0].range_m, 1e-14);
  EXPECT_NEAR(mixed.echo[0].signal, up.echo[0].signal, 1e-14);
  EXPECT_NEAR(mixed.echo[0].sigma_m, up.echo[0].sigma_m, 1e-14);
  // of two equally strong ones the nearer
  EXPECT_EQ(mixed.path[mixed.echo[0].strongest].range_m, 20.05);
  EXPECT_EQ(up.path[up.echo[0].strongest].range_m, 20.05);
}

TEST(WaveformBuffer, DropsTheWeakestContributionsWhenFull) {
  WaveformBuffer work;
  for (std::size_t i = 0; i <= WaveformBuffer::kMax; ++i) {
    work.add({10.0, i == 7 ? 0.5 : 1.0, static_cast<std::uint32_t>(i), ReturnSource::surface});
  }
  EXPECT_EQ(work.paths, WaveformBuffer::kMax);
  for (std::size_t i = 0; i < work.paths; ++i) EXPECT_NE(work.path[i].source, 7U);
}

// The walk of a fixed threshold is -(c / 2) sigma_p sqrt(2 ln(A / T)).
TEST(ReportedRange, HasRangeWalkForLeadingEdgeTiming) {
  Receiver receiver{.pulse_fwhm_s = 5e-9, .timing = Receiver::Timing::leading_edge};
  const double sigma_m = pulse_sigma_m(receiver);
  EXPECT_NEAR(sigma_m, 0.318, 5e-4);  // c FWHM / 4.71
  for (const double signal : {1.0, 2.0, 10.0, 1000.0}) {
    const PulseEcho echo{
        .range_m = 50.0, .signal = signal, .sigma_m = sigma_m, .strongest = 0, .is_mixed = false};
    const double walk_m = -sigma_m * std::sqrt(2.0 * std::log(signal));
    EXPECT_NEAR(reported_range_m(receiver, echo), 50.0 + walk_m, 1e-12);
    receiver.timing = Receiver::Timing::centroid;
    EXPECT_EQ(reported_range_m(receiver, echo), 50.0);
    receiver.timing = Receiver::Timing::leading_edge;
  }
}

TEST(EnforceMinSeparation, RemovesEchoesCloseToAStrongerOne) {
  WaveformBuffer work = echoes_of({{10.0, 1.0}, {11.0, 3.0}, {15.0, 2.0}});
  ASSERT_EQ(work.echoes, 3U);
  enforce_min_separation(0.5, work);
  EXPECT_EQ(work.echoes, 3U);
  enforce_min_separation(1.5, work);
  ASSERT_EQ(work.echoes, 2U);
  EXPECT_NEAR(work.echo[0].range_m, 11.0, 1e-3);
  EXPECT_NEAR(work.echo[1].range_m, 15.0, 1e-9);
}

/// Three echoes: weak, strong, medium.
std::vector<int> chosen_of(const std::vector<Return>& returns, std::size_t count = 3) {
  const WaveformBuffer work = echoes_of({{10.0, 1.0}, {20.0, 3.0}, {30.0, 2.0}});
  std::array<int, kMaxReturns> chosen{};
  select_returns({.returns = returns}, {work.echo.data(), count}, chosen);
  return {chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(returns.size())};
}

TEST(SelectReturns, FindsFirstStrongestSecondAndLast) {
  using Order = Return::Order;
  EXPECT_EQ(chosen_of({{Order::nearest, 0}}), std::vector<int>({0}));
  EXPECT_EQ(chosen_of({{Order::strongest, 0}}), std::vector<int>({1}));
  EXPECT_EQ(chosen_of({{Order::strongest, 1}}), std::vector<int>({2}));
  EXPECT_EQ(chosen_of({{Order::farthest, 0}}), std::vector<int>({2}));
  EXPECT_EQ(chosen_of({{Order::nearest, 0}, {Order::nearest, 1}, {Order::nearest, 2}}),
            std::vector<int>({0, 1, 2}));
}

// A dual return reports strongest and last; if they are the same, the second strongest.
TEST(SelectReturns, ReportsNoEchoTwice) {
  using Order = Return::Order;
  const std::vector<Return> dual = {{Order::strongest, 0}, {Order::farthest, 0}};
  EXPECT_EQ(chosen_of(dual), std::vector<int>({1, 2}));
  EXPECT_EQ(chosen_of(dual, 2), std::vector<int>({1, 0}));
  EXPECT_EQ(chosen_of(dual, 1), std::vector<int>({0, -1}));
  EXPECT_EQ(chosen_of(dual, 0), std::vector<int>({-1, -1}));
}

TEST(ValidateReceiver, ReportsTheNumberOutOfRange) {
  EXPECT_NO_THROW(validate(Receiver{}));
  EXPECT_THROW(validate(Receiver{.pulse_fwhm_s = 0.0}), Error);
  EXPECT_THROW(validate(Receiver{.min_return_separation_m = -1.0}), Error);
  EXPECT_THROW(validate(Receiver{.returns = {}}), Error);
}

}  // namespace
}  // namespace glidar
