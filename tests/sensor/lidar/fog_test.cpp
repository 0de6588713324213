// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/fog.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sensor/distribution.hpp>
#include <support/error_text.hpp>
#include <support/parameter_name.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

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

using ::testing::HasSubstr;

constexpr double kShortFwhm_s = 5e-9;
constexpr double kBackscatter = 1.2e-3;  // of fog of 50 m visibility
constexpr double kCell_m = 0.5 * 299792458.0 * kShortFwhm_s;
constexpr LidarEquation kLight{.reference_range_m = 100.0, .weather_extinction_per_m = 0.078};

/// Of Erlang's distribution with mean 1.
double gamma_cdf(unsigned looks, double x) {
  double term = std::exp(-(looks * x));
  double sum = 0.0;
  for (unsigned k = 0; k < looks; ++k) {
    sum += term;
    term *= looks * x / (k + 1);
  }
  return 1.0 - sum;
}

class FogVariation : public ::testing::TestWithParam<unsigned> {};

TEST_P(FogVariation, CellsHaveGammaDistributedFactorsOfMeanOne) {
  const unsigned looks = GetParam();
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kShortFwhm_s, looks);
  EXPECT_DOUBLE_EQ(fog.cell_m, kCell_m);
  std::vector<FogCell> cells;
  std::vector<double> shares;
  std::vector<double> places;
  double sum = 0.0;
  for (std::uint32_t beam = 0; beam < 3000; ++beam) {
    sample_fog_cells(fog, 5.0, {.seed = 7, .beam = beam}, cells);
    ASSERT_GE(cells.size(), 5U);
    EXPECT_EQ(cells[0].from_m, 0.9);
    places.push_back((cells[1].from_m - 0.9) / kCell_m);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 1) {
        EXPECT_NEAR(cells[i].from_m - cells[i - 1].from_m, kCell_m, 1e-12);
      }
      shares.push_back(gamma_cdf(looks, cells[i].factor));
      sum += cells[i].factor;
    }
  }
  EXPECT_LT(testing::kolmogorov(shares), testing::kKolmogorovLimit);
  EXPECT_LT(testing::kolmogorov(places), testing::kKolmogorovLimit);
  const auto n = static_cast<double>(shares.size());
  EXPECT_NEAR(sum / n, 1.0, 4.0 / std::sqrt(n * looks));  // four standard errors
}

// A layer much thinner than a cell: its echo is the cell's factor times that of even fog, so that
// the mean power is kept.
TEST_P(FogVariation, EchoOfAThinLayerIsGammaDistributedAroundThatOfUniformFog) {
  const unsigned looks = GetParam();
  LidarEquation light = kLight;
  light.overlap = {{1.0, 0.0}, {1.0001, 1.0}, {1.0002, 1.0}};
  const VaryingFog fog = varying_fog(light, kBackscatter, kShortFwhm_s, looks);
  const double even =
      fog_signal(fog_profile(light, kBackscatter, kShortFwhm_s), 1.0001 + kCell_m, 1.0002);
  std::vector<double> shares;
  double sum = 0.0;
  constexpr std::uint32_t kBeams = 10000;
  for (std::uint32_t beam = 0; beam < kBeams; ++beam) {
    const SoftEcho echo = echo_before(fog, 1.0002, {.seed = 3, .beam = beam});
    EXPECT_NEAR(echo.range_m, 1.0001, 1e-4);
    shares.push_back(gamma_cdf(looks, echo.signal / even));
    sum += echo.signal / even;
  }
  EXPECT_LT(testing::kolmogorov(shares), testing::kKolmogorovLimit);
  EXPECT_NEAR(sum / kBeams, 1.0, 4.0 / std::sqrt(1.0 * kBeams * looks));
}

INSTANTIATE_TEST_SUITE_P(Looks, FogVariation, ::testing::Values(1U, 4U, 64U),
                         testing::parameter_name<unsigned>);

/// S at a time, by the midpoint rule over the cells.
double signal_of_cells(const std::vector<FogCell>& cells, double range_m, double end_m) {
  constexpr int kSteps = 200;
  const double from_m = std::max(0.9, range_m - 2.0 * kCell_m);
  const double to_m = std::min(range_m, end_m);
  double sum = 0.0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double a = std::max(from_m, cells[k].from_m);
    const double b = std::min(to_m, k + 1 < cells.size() ? cells[k + 1].from_m : end_m);
    for (int i = 0; i < kSteps && b > a; ++i) {
      const double r = a + (i + 0.5) / kSteps * (b - a);
      const double sine = std::sin(std::numbers::pi * (range_m - r) / (2.0 * kCell_m));
      const double white = received_signal(kLight, 1.0, r) * std::min(1.0, (r - 0.9) / 0.1);
      sum += cells[k].factor * std::numbers::pi * kBackscatter * white * sine * sine * (b - a) /
             kSteps;
    }
  }
  return sum;
}

TEST(VaryingFog, EchoIsTheLargestValueOfTheSumOverItsCells) {
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kShortFwhm_s, 1);
  std::vector<FogCell> cells;
  for (std::uint32_t beam = 0; beam < 12; ++beam) {
    const double end_m = beam % 3 == 0 ? 1.6 : 9.0;
    const RngKey draw{.seed = 11, .beam = beam};
    sample_fog_cells(fog, end_m, draw, cells);
    SoftEcho best;
    for (double range_m = 0.9; range_m < end_m + 2.0 * kCell_m; range_m += 0.01) {
      const double signal = signal_of_cells(cells, range_m, end_m);
      if (signal > best.signal) best = {range_m - kCell_m, signal};
    }
    const SoftEcho echo = echo_before(fog, end_m, draw);
    EXPECT_NEAR(echo.signal, best.signal, 3e-3 * best.signal) << beam;
    EXPECT_NEAR(echo.range_m, best.range_m, 0.03) << beam;
  }
}

// The program of Hahner et al. (LiDAR_fog_sim, noise variant v4) shifts fog's echoes by 10 m times
// a beta distributed number of 2 and 20, which makes them look like recorded ones: 0.60 m rms.
TEST(VaryingFog, EchoRangesSpreadLikeRecordedOnes) {
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kShortFwhm_s, 1);
  const double even_m =
      echo_before(fog_return(kLight, kBackscatter, kShortFwhm_s), kEndless).range_m;
  double sum = 0.0;
  double squares = 0.0;
  constexpr std::uint32_t kBeams = 4000;
  for (std::uint32_t beam = 0; beam < kBeams; ++beam) {
    const double shift_m = echo_before(fog, kEndless, {.beam = beam}).range_m - even_m;
    sum += shift_m;
    squares += shift_m * shift_m;
  }
  const double mean = sum / kBeams;
  EXPECT_NEAR(std::sqrt(squares / kBeams - mean * mean), 0.6, 0.15);
  EXPECT_GT(mean, 0.1);
}

TEST(VaryingFog, DoesNotDependOnTheTargetBehindIt) {
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kShortFwhm_s, 2);
  std::vector<FogCell> near;
  std::vector<FogCell> far;
  for (std::uint32_t beam = 0; beam < 200; ++beam) {
    const RngKey draw{.seed = 2, .beam = beam};
    sample_fog_cells(fog, 2.0, draw, near);
    sample_fog_cells(fog, 8.0, draw, far);
    ASSERT_LT(near.size(), far.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      EXPECT_EQ(near[i].from_m, far[i].from_m);
      EXPECT_EQ(near[i].factor, far[i].factor);
    }
    EXPECT_LE(echo_before(fog, 1.3, draw).range_m, 1.3);
    EXPECT_EQ(echo_before(fog, kEndless, draw).signal, echo_before(fog, 1e4, draw).signal);
  }
  EXPECT_EQ(echo_before(fog, 0.5, {}).signal, 0.0);
}

TEST(VaryingFog, IsZeroWithoutBackscatter) {
  EXPECT_EQ(echo_before(varying_fog(kLight, 0.0, kShortFwhm_s, 1), kEndless, {}).signal, 0.0);
}

TEST(VaryingFog, OfSoManyCellsThatRandomNumbersWouldRepeatIsRefused) {
  EXPECT_THAT(error_text([] { varying_fog(kLight, kBackscatter, 1e-14, 64); }),
              ::testing::AllOf(HasSubstr("weather, random numbers of the fog in a beam"),
                               HasSubstr("decrease fog_looks")));
}

}  // namespace
}  // namespace glidar
