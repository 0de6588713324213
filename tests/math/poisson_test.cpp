// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/gaussian.hpp>
#include <glidar/math/poisson.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

double sample(double mean, std::uint32_t beam) {
  const RandomWords words = random_words({.seed = 7, .beam = beam});
  return sample_poisson(mean, uniform(words[0]), normals(words)[0]);
}

TEST(Poisson, MeanVarianceAndSkewnessAreThoseOfTheDistribution) {
  constexpr int kCount = 400000;
  for (const double mean : {0.3, 4.0, 31.9, 32.1, 300.0, 2e5}) {
    double sum = 0.0;
    double squares = 0.0;
    double cubes = 0.0;
    for (int i = 0; i < kCount; ++i) {
      const double error = sample(mean, static_cast<std::uint32_t>(i)) - mean;
      sum += error;
      squares += error * error;
      cubes += error * error * error;
    }
    const double root = std::sqrt(mean);
    // four standard errors of each moment
    EXPECT_NEAR(sum / kCount, 0.0, 4.0 * root / std::sqrt(kCount)) << mean;
    EXPECT_NEAR(squares / kCount / mean, 1.0, 4.0 * std::sqrt((2.0 + 1.0 / mean) / kCount)) << mean;
    EXPECT_NEAR(cubes / kCount / (mean * root), 1.0 / root,
                4.0 * std::sqrt((15.0 + 40.0 / mean) / kCount))
        << mean;
  }
}

TEST(Poisson, SmallMeansHaveTheProbabilityOfEachNumber) {
  constexpr int kCount = 200000;
  int zeros = 0;
  for (int i = 0; i < kCount; ++i)
    zeros += sample(1.5, static_cast<std::uint32_t>(i)) == 0.0 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(zeros) / kCount, std::exp(-1.5), 0.004);
}

TEST(Poisson, NumbersAreWholeAndNotNegative) {
  EXPECT_EQ(sample_poisson(0.0, 0.999999, 9.0), 0.0);
  EXPECT_EQ(sample_poisson(33.0, 0.5, -8.0), 0.0);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double number = sample(50.0, i);
    EXPECT_EQ(number, std::floor(number));
  }
}

}  // namespace
}  // namespace glidar
