// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/fog_variation.hpp>

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

using ::testing::HasSubstr;

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kFwhm_s = 5e-9;
constexpr double kBackscatter = 1.2e-3;  // of fog of 50 m visibility
constexpr double kCell_m = 0.5 * 299792458.0 * kFwhm_s;
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
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kFwhm_s, looks);
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
  const VaryingFog fog = varying_fog(light, kBackscatter, kFwhm_s, looks);
  const double even =
      fog_signal(fog_profile(light, kBackscatter, kFwhm_s), 1.0001 + kCell_m, 1.0002);
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
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kFwhm_s, 1);
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
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kFwhm_s, 1);
  const double even_m = echo_before(fog_return(kLight, kBackscatter, kFwhm_s), kEndless).range_m;
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
  const VaryingFog fog = varying_fog(kLight, kBackscatter, kFwhm_s, 2);
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
  EXPECT_EQ(echo_before(varying_fog(kLight, 0.0, kFwhm_s, 1), kEndless, {}).signal, 0.0);
}

TEST(VaryingFog, OfSoManyCellsThatRandomNumbersWouldRepeatIsRefused) {
  EXPECT_THAT(error_text([] { varying_fog(kLight, kBackscatter, 1e-14, 64); }),
              ::testing::AllOf(HasSubstr("weather, random numbers of the fog in a beam"),
                               HasSubstr("decrease fog_looks")));
}

}  // namespace
}  // namespace glidar
