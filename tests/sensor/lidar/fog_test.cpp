// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/fog.hpp>

#include <gtest/gtest.h>
#include <support/parameter_name.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr double kLight_m_per_s = 299792458.0;
constexpr double kFwhm_s = 20e-9;
constexpr double kHalfPulse_m = 0.5 * kLight_m_per_s * kFwhm_s;
constexpr double kEndless = std::numeric_limits<double>::infinity();
/// S is then the integral I_s of Hahner et al., which is one over time and lacks c / 2.
constexpr double kUnitBackscatter = 2.0 / (std::numbers::pi * kLight_m_per_s);

/// A lidar equation whose S is the backscatter over R^2 times the transmission.
LidarEquation unit_light(double extinction_per_m) {
  return {.reference_reflectance = 1.0,
          .reference_range_m = 1.0,
          .weather_extinction_per_m = extinction_per_m};
}

/// The part of I_s that comes from ranges between two, by the midpoint rule.
double part_of_integral(double alpha, double range_m, double from_m, double to_m) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = from_m + (i + 0.5) / kSteps * (to_m - from_m);
    const double pulse = std::sin(std::numbers::pi * (range_m - r) / (kLight_m_per_s * kFwhm_s));
    sum += pulse * pulse * std::exp(-2.0 * alpha * r) / (r * r) * std::min(1.0, (r - 0.9) / 0.1);
  }
  return sum * std::max(0.0, to_m - from_m) / kSteps * 2.0 / kLight_m_per_s;
}

/// I_s, in one part up to the range of full overlap, and one beyond.
double soft_integral(double alpha, double range_m, double hard_range_m) {
  const double from_m = std::max(0.9, range_m - 2.0 * kHalfPulse_m);
  const double to_m = std::min(range_m, hard_range_m);
  return part_of_integral(alpha, range_m, from_m, std::min(1.0, to_m)) +
         part_of_integral(alpha, range_m, std::max(1.0, from_m), to_m);
}

struct Golden {
  double alpha;
  double peak;  ///< 1e-9 s / m^2, published
  double range_m;
  double exact_peak;  ///< the same, by 2e6 steps of the midpoint rule
};

void PrintTo(const Golden& golden, std::ostream* out) {
  *out << "alpha " << golden.alpha;
}

class SoftReturn : public ::testing::TestWithParam<Golden> {};

TEST_P(SoftReturn, HasThePublishedPeak) {
  const auto& [alpha, peak, peak_range_m, exact_peak] = GetParam();
  const FogProfile profile = fog_profile(unit_light(alpha), kUnitBackscatter, kFwhm_s);
  // the publication samples every 0.1 m
  double best = 0.0;
  double best_range_m = 0.0;
  for (int i = 10; i <= 100; ++i) {
    const double signal = fog_signal(profile, 0.1 * i, 5.0);
    if (signal > best) best_range_m = 0.1 * i;
    best = std::max(best, signal);
  }
  EXPECT_NEAR(best, 1e-9 * exact_peak, 1e-14);
  EXPECT_NEAR(best, 1e-9 * peak, 6e-5 * best);  // the error of the published sums
  EXPECT_NEAR(best_range_m, peak_range_m, 1e-9);
  const FogReturn fog = fog_return(unit_light(alpha), kUnitBackscatter, kFwhm_s);
  const SoftEcho echo = echo_before(fog, kEndless);
  EXPECT_GE(echo.signal, best);
  EXPECT_NEAR(echo.signal, best, 1e-3 * best);
  EXPECT_NEAR(echo.range_m, peak_range_m - 2.998, 0.05);
}

TEST_P(SoftReturn, IsTheIntegralAtAnyTimeAndInFrontOfAnyTarget) {
  const double alpha = GetParam().alpha;
  const FogProfile profile = fog_profile(unit_light(alpha), kUnitBackscatter, kFwhm_s);
  const double scale = 1e-9 * GetParam().peak;
  for (const double range_m : {0.95, 1.3, 3.0, 4.61, 6.2, 6.95}) {
    for (const double hard_range_m : {0.93, 1.0, 2.2, 4.7, 50.0}) {
      EXPECT_NEAR(fog_signal(profile, range_m, hard_range_m),
                  soft_integral(alpha, range_m, hard_range_m), 1e-5 * scale)
          << range_m << " " << hard_range_m;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Hahner, SoftReturn,
                         ::testing::Values(Golden{0.005, 4.56799, 4.70, 4.567969},
                                           Golden{0.02, 4.34657, 4.70, 4.346633},
                                           Golden{0.06, 3.81564, 4.60, 3.815421},
                                           Golden{0.2, 2.47599, 4.50, 2.475990}),
                         testing::parameter_name<Golden>);

TEST(FogReturn, DependsOnNearTargetsAndNotOnFarOnes) {
  const FogReturn fog = fog_return(unit_light(0.06), kUnitBackscatter, kFwhm_s);
  const SoftEcho far = echo_before(fog, kEndless);
  for (const double hard_range_m : {5.0, 30.0, 1e6}) {
    EXPECT_EQ(echo_before(fog, hard_range_m).signal, far.signal);
    EXPECT_EQ(echo_before(fog, hard_range_m).range_m, far.range_m);
  }
  double before = 0.0;
  for (const double hard_range_m : {0.92, 0.97, 1.0, 1.1, 1.4, 2.0, 2.7, 3.5, 4.2, 4.6, 4.7, 4.9}) {
    SoftEcho peak;
    for (double range_m = 3.6; range_m < 5.0; range_m += 0.005) {
      const double signal = soft_integral(0.06, range_m, hard_range_m);
      if (signal > peak.signal) peak = {range_m - kHalfPulse_m, signal};
    }
    const SoftEcho echo = echo_before(fog, hard_range_m);
    EXPECT_NEAR(echo.signal, peak.signal, 1e-3 * far.signal) << hard_range_m;
    EXPECT_NEAR(echo.range_m, peak.range_m, 0.02) << hard_range_m;
    EXPECT_LT(echo.range_m, hard_range_m);
    EXPECT_GE(echo.signal, before);
    before = echo.signal;
  }
  EXPECT_EQ(echo_before(fog, 0.9).signal, 0.0);
  EXPECT_EQ(echo_before(fog, 0.1).signal, 0.0);
}

TEST(FogReturn, UsesTheNearRangeOfTheOverlapTable) {
  LidarEquation light = unit_light(0.06);
  const SoftEcho expected = echo_before(fog_return(light, 1e-3, kFwhm_s), kEndless);
  light.overlap = {{0.9, 0.0}, {1.0, 1.0}};
  const SoftEcho found = echo_before(fog_return(light, 1e-3, kFwhm_s), kEndless);
  // the share at the reference range of 1 m is all
  EXPECT_NEAR(found.signal, expected.signal, 1e-9 * expected.signal);
  light.overlap = {{2.9, 0.0}, {3.0, 1.0}};
  light.reference_range_m = 4.0;
  EXPECT_GT(echo_before(fog_return(light, 1e-3, kFwhm_s), kEndless).range_m, 3.0);
}

TEST(FogReturn, FindsAFarPeakWhereTheOverlapIncreasesWithRange) {
  LidarEquation light{.reference_range_m = 100.0, .weather_extinction_per_m = 0.002};
  light.overlap = {{1.0, 0.0}, {99.0, 1.0}, {100.0, 1000.0}, {101.0, 1000.0}};
  const SoftEcho echo = echo_before(fog_return(light, 1e-3, 5e-9), kEndless);
  EXPECT_NEAR(echo.range_m, 101.0, 1.0);
}

TEST(FogReturn, OfAShortPulseIsThatOfALayer) {
  // A pulse of 0.01 ns: the integral of sin^2 is half its length of c FWHM, and the fog just beyond
  // 1 m, where the overlap is complete, is the brightest.
  constexpr double kShort_s = 1e-11;
  const double alpha = 0.05;
  const SoftEcho echo = echo_before(fog_return(unit_light(alpha), 2e-3, kShort_s), kEndless);
  const double expected =
      std::numbers::pi * 2e-3 * 0.5 * kLight_m_per_s * kShort_s * std::exp(-2.0 * alpha);
  EXPECT_NEAR(echo.signal, expected, 5e-3 * expected);
  EXPECT_NEAR(echo.range_m, 1.0, 2e-3);
}

TEST(FogReturn, IsZeroWithoutBackscatter) {
  EXPECT_EQ(echo_before(fog_return(unit_light(0.06), 0.0, kFwhm_s), kEndless).signal, 0.0);
}

}  // namespace
}  // namespace glidar
