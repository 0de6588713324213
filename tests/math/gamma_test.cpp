// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/gamma.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

constexpr std::uint32_t kNumbers = 160000;

double number(double deviation, std::uint32_t beam) {
  return sample_gamma(deviation, {.seed = 3, .beam = beam, .purpose = Purpose::verification});
}

// Within 4 standard errors of the mean; the deviation within 1.5 %, 8 of its standard errors for
// small deviations and 3 for 1, whose kurtosis is 9.
TEST(Gamma, HasMeanOneAndItsStandardDeviation) {
  for (const double deviation : {0.1, 0.5, 1.0}) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::uint32_t i = 0; i < kNumbers; ++i) {
      const double x = number(deviation, i);
      sum += x;
      squares += x * x;
    }
    const double mean = sum / kNumbers;
    EXPECT_NEAR(mean, 1.0, 4.0 * deviation / std::sqrt(kNumbers)) << deviation;
    EXPECT_NEAR(std::sqrt(squares / kNumbers - mean * mean), deviation, 0.015 * deviation);
  }
  EXPECT_EQ(number(0.0, 0), 1.0);
}

// Of deviation 1 it is exponential: P(x > 1) = 1 / e, P(x > 3) = e^-3, with standard errors of
// 0.0012.
TEST(Gamma, IsExponentialForADeviationOfOne) {
  for (const double limit : {1.0, 3.0}) {
    std::uint32_t above = 0;
    for (std::uint32_t i = 0; i < kNumbers; ++i) above += number(1.0, i) > limit ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(above) / kNumbers, std::exp(-limit), 0.005) << limit;
  }
}

}  // namespace
}  // namespace glidar
