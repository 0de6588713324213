// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/precipitation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sensor/distribution.hpp>
#include <support/error_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace glidar {
namespace {

using ::testing::HasSubstr;

using testing::chi_square;
using testing::chi_square_limit;
using testing::kKolmogorovLimit;
using testing::kolmogorov;

constexpr double kNoTarget = std::numeric_limits<double>::infinity();

std::vector<DropEcho> drops_of(const LidarEquation& light, const DropField& field,
                               double hard_range_m, std::uint32_t beam) {
  std::vector<DropEcho> drops;
  const auto take = [&](const DropEcho& drop) { drops.push_back(drop); };
  sample_drops(light, field, hard_range_m, {.seed = 5, .beam = beam, .purpose = Purpose::weather},
               FunctionRef<void(const DropEcho&)>(take));
  return drops;
}

/// So strong and so near that every drop is detected.
LidarEquation strong_light() {
  return {.reference_range_m = 1e6, .overlap = {{1e-3, 0.0}, {2e-3, 1.0}}};
}

TEST(Drops, NumberIsPoissonDistributedWithTheConesVolume) {
  constexpr std::uint32_t kBeams = 40000;
  constexpr double kRange_m = 7.5;
  const DropField field =
      drop_field(strong_light(), rain_sizes(50.0), {.divergence_rad = 0.003}, 0.1);
  const double radius_m = 0.5 * 0.003 * kRange_m;
  const double mean = 4055.0 * std::numbers::pi / 3.0 * radius_m * radius_m * kRange_m;
  std::array<double, 14> found{};  // the last: 13 and more
  double sum = 0.0;
  for (std::uint32_t beam = 0; beam < kBeams; ++beam) {
    const std::size_t count = drops_of(strong_light(), field, kRange_m, beam).size();
    found[std::min(count, found.size() - 1)] += 1.0;
    sum += static_cast<double>(count);
  }
  EXPECT_NEAR(sum / kBeams, mean, 4.0 * std::sqrt(mean / kBeams));
  std::array<double, 14> expected{};
  double rest = kBeams;
  double term = kBeams * std::exp(-mean);
  for (std::size_t k = 0; k + 1 < expected.size(); ++k) {
    expected[k] = term;
    rest -= term;
    term *= mean / static_cast<double>(k + 1);
  }
  expected.back() = rest;
  EXPECT_LT(chi_square(found, expected), chi_square_limit(13));
}

TEST(Drops, RangesFollowTheVolumeAndDiametersAreExponential) {
  constexpr double kRange_m = 20.0;
  const DropSizes sizes = rain_sizes(10.0);
  const DropField field = drop_field(strong_light(), sizes, {.divergence_rad = 0.003}, 0.1);
  std::vector<double> by_range;
  std::vector<double> by_size;
  for (std::uint32_t beam = 0; beam < 1000; ++beam) {
    for (const DropEcho& drop : drops_of(strong_light(), field, kRange_m, beam)) {
      by_range.push_back(std::pow(drop.range_m / kRange_m, 3.0));
      by_size.push_back(1.0 - std::exp(-sizes.slope_per_m * (drop.diameter_m - kMinDrop_m)));
    }
  }
  EXPECT_GT(by_range.size(), 40000U);
  EXPECT_LT(kolmogorov(by_range), kKolmogorovLimit);
  EXPECT_LT(kolmogorov(by_size), kKolmogorovLimit);
}

TEST(Drops, FillACylindricalBeamUniformly) {
  const DropField field = drop_field(strong_light(), rain_sizes(10.0),
                                     {.divergence_rad = 0.0, .exit_diameter_m = 0.02}, 0.1);
  std::vector<double> by_range;
  for (std::uint32_t beam = 0; beam < 2000; ++beam) {
    for (const DropEcho& drop : drops_of(strong_light(), field, 20.0, beam)) {
      by_range.push_back((drop.range_m - 1e-3) / (20.0 - 1e-3));
    }
  }
  const double mean = 2000.0 * 2789.0 * 0.25 * std::numbers::pi * 0.02 * 0.02 * 20.0;
  EXPECT_NEAR(static_cast<double>(by_range.size()), mean, 4.0 * std::sqrt(mean));
  EXPECT_LT(kolmogorov(by_range), kKolmogorovLimit);
}

/// Every drop of a beam up to a range, one by one, with all formulas written out.
class EveryDrop {
 public:
  static constexpr double kDivergence_rad = 0.003;
  static constexpr double kExit_m = 0.0095;
  static constexpr double kExtinction_per_m = 0.005;

  explicit EveryDrop(double end_m) : end_m_(end_m) {}

  static double diameter_m(double range_m) { return kExit_m + kDivergence_rad * range_m; }
  static double signal(double range_m, double drop_m) {
    const double share = std::min(1.0, std::pow(drop_m / diameter_m(range_m), 2.0));
    const double crossover = std::clamp((range_m - 0.9) / 0.1, 0.0, 1.0);
    return std::pow(0.328 / 2.328, 2.0) * share / 0.8 * std::pow(100.0 / range_m, 2.0) * crossover *
           std::exp(-2.0 * kExtinction_per_m * range_m);
  }
  std::vector<DropEcho> draw() {
    const double slope_per_m = 4100.0 * std::pow(50.0, -0.21);
    const double per_m3 = 8e6 / slope_per_m * std::exp(-slope_per_m * 5e-5);
    std::poisson_distribution<int> count(per_m3 * volume_m3());
    std::vector<DropEcho> drops;
    for (int left = count(random_); left > 0; --left) {
      double range_m = end_m_;
      do {
        range_m = end_m_ * uniform_(random_);
      } while (uniform_(random_) > std::pow(diameter_m(range_m) / diameter_m(end_m_), 2.0));
      const double drop_m = 5e-5 - std::log(1.0 - uniform_(random_)) / slope_per_m;
      drops.push_back({range_m, signal(range_m, drop_m), drop_m});
    }
    return drops;
  }

 private:
  /// A frustum: pi/12 h (D^2 + D d + d^2).
  [[nodiscard]] double volume_m3() const {
    const double end = diameter_m(end_m_);
    return std::numbers::pi / 12.0 * end_m_ * (end * end + end * kExit_m + kExit_m * kExit_m);
  }
  double end_m_;
  std::mt19937_64 random_{2024};
  std::uniform_real_distribution<double> uniform_;
};

/// Statistics of the detected drops of many beams.
struct Harvest {
  std::vector<double> ranges_m;
  std::vector<double> signals;
  std::vector<double> diameters_m;
  std::array<double, 5> beams_by_count{};  ///< the last: 4 and more

  void add(const std::vector<DropEcho>& drops) {
    for (const DropEcho& drop : drops) {
      ranges_m.push_back(drop.range_m);
      signals.push_back(drop.signal);
      diameters_m.push_back(drop.diameter_m);
    }
    beams_by_count[std::min(drops.size(), beams_by_count.size() - 1)] += 1.0;
  }
};

TEST(ThinnedDrops, HaveTheDistributionOfTheStrongestDrops) {
  constexpr double kMin = 0.02;
  constexpr double kRange_m = 15.0;
  constexpr std::uint32_t kBeams = 60000;
  const LidarEquation light{.reference_range_m = 100.0,
                            .weather_extinction_per_m = EveryDrop::kExtinction_per_m};
  const BeamShape beam{.divergence_rad = EveryDrop::kDivergence_rad,
                       .exit_diameter_m = EveryDrop::kExit_m};
  const DropField field = drop_field(light, rain_sizes(50.0), beam, kMin);
  Harvest thinned;
  Harvest all;
  EveryDrop every(kRange_m);
  for (std::uint32_t k = 0; k < kBeams; ++k) {
    thinned.add(drops_of(light, field, kRange_m, k));
    std::vector<DropEcho> strong = every.draw();
    std::erase_if(strong, [&](const DropEcho& drop) { return drop.signal < kMin; });
    all.add(strong);
  }
  EXPECT_GT(all.signals.size(), 20000U);
  const auto count = static_cast<double>(all.signals.size());
  EXPECT_NEAR(static_cast<double>(thinned.signals.size()), count, 4.0 * std::sqrt(2.0 * count));
  EXPECT_LT(kolmogorov(thinned.ranges_m, all.ranges_m), kKolmogorovLimit);
  EXPECT_LT(kolmogorov(thinned.signals, all.signals), kKolmogorovLimit);
  EXPECT_LT(kolmogorov(thinned.diameters_m, all.diameters_m), kKolmogorovLimit);
  double distance = 0.0;  // chi-square of two samples of one size
  for (std::size_t k = 0; k < thinned.beams_by_count.size(); ++k) {
    const double difference = thinned.beams_by_count[k] - all.beams_by_count[k];
    distance += difference * difference / (thinned.beams_by_count[k] + all.beams_by_count[k]);
  }
  EXPECT_LT(distance, chi_square_limit(4));
}

TEST(ThinnedDrops, HaveTheSignalOfTheirShareOfTheBeam) {
  const LidarEquation light{.reference_range_m = 100.0,
                            .weather_extinction_per_m = EveryDrop::kExtinction_per_m};
  const DropField field =
      drop_field(light, rain_sizes(50.0),
                 {.divergence_rad = EveryDrop::kDivergence_rad, .exit_diameter_m = 0.0095}, 0.02);
  for (std::uint32_t beam = 0; beam < 1000; ++beam) {
    for (const DropEcho& drop : drops_of(light, field, 40.0, beam)) {
      EXPECT_NEAR(drop.signal, EveryDrop::signal(drop.range_m, drop.diameter_m),
                  1e-12 * drop.signal);
      EXPECT_GE(drop.signal, 0.02);
    }
  }
}

TEST(ThinnedDrops, AreFewWhereThousandsAreInTheBeam) {
  const LidarEquation light{.reference_range_m = 100.0};
  const BeamShape beam{.divergence_rad = 0.003, .exit_diameter_m = 0.0095};
  const DropSizes sizes = rain_sizes(100.0);
  const DropField field = drop_field(light, sizes, beam, 0.1);
  EXPECT_GT(drops_per_m3(sizes, kMinDrop_m) * beam_volume_m3(beam, 100.0), 10000.0);
  // the exact mean, by the midpoint rule
  double mean = 0.0;
  constexpr double kStep_m = 1e-3;
  for (double r = 0.9 + 0.5 * kStep_m; r < 200.0; r += kStep_m) {
    const double white = std::pow(100.0 / r, 2.0) / 0.8 * std::clamp((r - 0.9) / 0.1, 0.0, 1.0);
    const double share = 0.1 / (sizes.reflectance * white);
    if (share > 1.0) continue;
    const double diameter_m = beam_diameter_m(beam, r);
    mean += 0.25 * std::numbers::pi * diameter_m * diameter_m * kStep_m *
            drops_per_m3(sizes, std::max(5e-5, diameter_m * std::sqrt(share)));
  }
  const double drawn = field.shells.back().mean_before;
  EXPECT_GE(drawn, mean);
  EXPECT_LT(drawn, 1.3 * mean);
  EXPECT_LT(drawn, 5.0);
  double found = 0.0;
  constexpr std::uint32_t kBeams = 50000;
  for (std::uint32_t k = 0; k < kBeams; ++k) {
    found += static_cast<double>(drops_of(light, field, kNoTarget, k).size());
  }
  EXPECT_NEAR(found / kBeams, mean, 4.0 * std::sqrt(mean / kBeams));
}

TEST(ThinnedDrops, FollowANonlinearOverlap) {
  // as many are found as the exact bound allows, with an overlap that rises and falls
  LidarEquation light{.reference_range_m = 20.0};
  light.overlap = {{0.0, 0.3}, {2.0, 0.1}, {3.3, 2.0}, {8.0, 0.05}, {20.0, 1.0}};
  const BeamShape beam{.divergence_rad = 0.001, .exit_diameter_m = 0.002};
  const DropSizes sizes = snow_sizes(4.0, Weather::SnowModel::sekhon_srivastava);
  const DropField field = drop_field(light, sizes, beam, 0.05);
  double mean = 0.0;
  constexpr double kStep_m = 1e-3;
  for (double r = 0.9 + 0.5 * kStep_m; r < 100.0; r += kStep_m) {
    const double white = received_signal(light, 1.0, r) * std::clamp((r - 0.9) / 0.1, 0.0, 1.0);
    const double share = 0.05 / (sizes.reflectance * white);
    if (!(share <= 1.0)) continue;
    const double diameter_m = beam_diameter_m(beam, r);
    mean += 0.25 * std::numbers::pi * diameter_m * diameter_m * kStep_m *
            drops_per_m3(sizes, std::max(5e-5, diameter_m * std::sqrt(share)));
  }
  double found = 0.0;
  constexpr std::uint32_t kBeams = 200000;
  for (std::uint32_t k = 0; k < kBeams; ++k) {
    found += static_cast<double>(drops_of(light, field, kNoTarget, k).size());
  }
  EXPECT_GT(found, 1000.0);
  EXPECT_NEAR(found, mean * kBeams, 4.0 * std::sqrt(mean * kBeams));
}

TEST(Drops, DoNotDependOnTheTargetBehindThem) {
  const LidarEquation light{.reference_range_m = 100.0};
  const DropField field = drop_field(light, rain_sizes(80.0), {}, 0.01);
  std::size_t compared = 0;
  for (std::uint32_t beam = 0; beam < 500; ++beam) {
    const std::vector<DropEcho> all = drops_of(light, field, kNoTarget, beam);
    const std::vector<DropEcho> near = drops_of(light, field, 4.0, beam);
    ASSERT_LE(near.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(i < near.size(), all[i].range_m < 4.0);
      if (i >= near.size()) continue;
      EXPECT_EQ(near[i].range_m, all[i].range_m);
      EXPECT_EQ(near[i].signal, all[i].signal);
      ++compared;
    }
    EXPECT_TRUE(drops_of(light, field, 0.5, beam).empty());
  }
  EXPECT_GT(compared, 100U);
}

TEST(Drops, DoNotExistInABeamWithoutWidth) {
  const DropField field =
      drop_field({}, rain_sizes(80.0), {.divergence_rad = 0.0, .exit_diameter_m = 0.0}, 0.01);
  EXPECT_TRUE(drops_of({}, field, kNoTarget, 0).empty());
}

TEST(Drops, OfABeamWithMoreThanAMillionAreRefused) {
  const DropField field =
      drop_field(strong_light(), rain_sizes(50.0), {.divergence_rad = 0.003}, 1e-6);
  EXPECT_THAT(error_text([&] { drops_of(strong_light(), field, kNoTarget, 0); }),
              ::testing::AllOf(HasSubstr("weather, mean number of detectable drops in a beam"),
                               HasSubstr("allowed: 1e6; increase min_signal")));
}

}  // namespace
}  // namespace glidar
