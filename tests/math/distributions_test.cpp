// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace glidar {
namespace {

constexpr double kNearLibm = 1e-12;  // far above both libraries' roundings, far below any noise

TEST(Elementary, LogarithmAgreesWithTheLibrary) {
  for (int i = 0; i < 100000; ++i) {
    const double x = uniform(random_words({.beam = static_cast<std::uint32_t>(i)})[0]);
    EXPECT_NEAR(portable_log(x), std::log(x), kNearLibm);
  }
  for (const double x : {0x1p-33, 1.0 - 0x1p-33, 0.5, 1.0, std::sqrt(0.5), 3.0, 1e9}) {
    EXPECT_NEAR(portable_log(x), std::log(x), kNearLibm) << x;
  }
}

TEST(Elementary, SineAndCosineAgreeWithTheLibrary) {
  for (int i = -40000; i <= 80000; ++i) {
    const double turns = i / 40000.0;
    const double angle = 2.0 * std::numbers::pi * turns;
    EXPECT_NEAR(sincos_turns(turns).sine, std::sin(angle), kNearLibm) << turns;
    EXPECT_NEAR(sincos_turns(turns).cosine, std::cos(angle), kNearLibm) << turns;
  }
}

TEST(Elementary, AngleOfAVectorIsTheInverseOfItsSineAndCosine) {
  for (int i = 0; i < 40000; ++i) {
    const double turns = i / 40000.0;
    const SineCosine v = sincos_turns(turns);
    const double found = atan2_turns(3.0 * v.sine, 3.0 * v.cosine);
    const double apart = std::abs(found - turns);
    EXPECT_LT(std::min(apart, 1.0 - apart), kNearLibm) << turns;
    EXPECT_LT(found, 1.0);
    EXPECT_GE(found, 0.0);
  }
  EXPECT_EQ(atan2_turns(0.0, 0.0), 0.0);
}

TEST(Elementary, ExponentialAgreesWithTheLibrary) {
  for (double x = -40.0; x < 3.0; x += 0.0137) {
    EXPECT_NEAR(portable_exp(x), std::exp(x), kNearLibm * std::max(1.0, std::exp(x))) << x;
  }
}

TEST(Elementary, ExponentialSaturatesAtZeroAndInfinity) {
  for (double x = -699.9; x < 699.9; x += 3.7) {
    EXPECT_NEAR(portable_exp(x) / std::exp(x), 1.0, 2e-15) << x;
  }
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  for (const double x : {-700.1, -745.2, -1e4, -1e300, -kEndless}) EXPECT_EQ(portable_exp(x), 0.0);
  for (const double x : {700.1, 710.0, 1e4, 1e300, kEndless}) EXPECT_EQ(portable_exp(x), kEndless);
}

TEST(Elementary, PowersAreWithinTheStatedErrorOfLongDoubles) {
  for (std::uint32_t i = 0; i < 300000; ++i) {
    const RandomWords words = random_words({.beam = i});
    const double base = uniform(words[0]);
    const double exponent = 200.0 * uniform(words[1]) * uniform(words[2]);
    const long double exact = std::pow(static_cast<long double>(base), exponent);
    const double bound = 3e-16 * (1.0 + std::abs(exponent * std::log(base)));
    if (exact < 1e-300L) continue;
    ASSERT_LT(std::abs(static_cast<double>(portable_pow(base, exponent) / exact - 1.0L)), bound)
        << base << " ^ " << exponent;
  }
}

TEST(Elementary, PowersOfZeroOneAndDenormalFloatsAreExact) {
  EXPECT_EQ(portable_pow(0.0, 0.0), 1.0);
  EXPECT_EQ(portable_pow(0.0, 12.5), 0.0);
  EXPECT_EQ(portable_pow(1.0, 1000.0), 1.0);
  EXPECT_EQ(portable_pow(0.3, 0.0), 1.0);
  EXPECT_EQ(portable_pow(1e-3, 1000.0), 0.0);
  EXPECT_NEAR(portable_pow(0x1p-149, 1.0), 0x1p-149, 0x1p-149 * 1e-13);
}

TEST(Gaussian, ReproducesTheGoldenNormals) {
  const RandomWords words = random_words({.seed = 12345, .frame = 7});
  const std::array<double, 4> n = normals(words);
  EXPECT_NEAR(n[0], -0.421419785220268, 1e-14);  // the recorded digits
  EXPECT_NEAR(n[1], -0.167788665100006, 1e-14);
  EXPECT_NEAR(n[2], -0.915809005690777, 1e-14);
  EXPECT_NEAR(n[3], 0.980779498188674, 1e-14);
}

TEST(Gaussian, IsBoxAndMullersFormula) {
  for (std::uint32_t beam = 0; beam < 10000; ++beam) {
    const RandomWords words = random_words({.seed = 3, .beam = beam});
    const double r = std::sqrt(-2.0 * std::log(uniform(words[0])));
    const double angle = 2.0 * std::numbers::pi * uniform(words[1]);
    EXPECT_NEAR(normals(words)[0], r * std::cos(angle), kNearLibm);
    EXPECT_NEAR(normals(words)[1], r * std::sin(angle), kNearLibm);
  }
}

TEST(Gaussian, BatchesAreIdenticalToSingleNumbers) {
  // the second start makes the beam's number overflow within the batch
  for (const std::uint32_t start : {0U, 768U, 0xFFFFFF80U}) {
    const RngKey draw{.seed = 0x123456789abcU, .sensor = 5, .frame = 9, .beam = start, .block = 2};
    WordBatch words;
    Batch<double> single;
    PairBatch pairs;
    PairBatch uniforms;
    sample_words(draw, words);
    sample_normals(draw, single);
    sample_normals(draw, pairs);
    sample_uniforms(draw, uniforms);
    for (std::uint32_t i = 0; i < kSampleBatch; ++i) {
      RngKey one = draw;
      one.beam += i;
      const RandomWords expected = random_words(one);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(words.word[k][i], expected[k]);
      EXPECT_EQ(single[i], normals(expected)[0]);
      EXPECT_EQ(pairs.first[i], normals(expected)[0]);
      EXPECT_EQ(pairs.second[i], normals(expected)[1]);
      EXPECT_EQ(uniforms.first[i], uniform(expected[0]));
      EXPECT_EQ(uniforms.second[i], uniform(expected[1]));
    }
  }
}

TEST(Gaussian, SharedBatchesUseAllWordsOfAQuarterOfTheCounters) {
  for (const std::uint32_t start : {0U, 768U, 0xFFFFFF00U}) {
    const RngKey draw{.seed = 0x123456789abcU, .sensor = 5, .frame = 9, .beam = start, .block = 2};
    Batch<double> shared;
    Batch<double> uniforms;
    sample_shared_normals(draw, shared);
    sample_shared_uniforms(draw, uniforms);
    for (std::uint32_t i = 0; i < kSampleBatch; ++i) {
      RngKey one = draw;
      one.beam = start / 4 + i % 64;
      const RandomWords words = random_words(one);
      EXPECT_EQ(shared[i], normals(words).at(i / 64));
      EXPECT_EQ(uniforms[i], uniform(words.at(i / 64)));
    }
  }
}

/// Normals of a million beams.
std::vector<double> million() {
  std::vector<double> sample;
  Batch<double> batch;
  for (std::uint32_t beam = 0; beam < 4000 * kSampleBatch; beam += kSampleBatch) {
    sample_shared_normals({.seed = 77, .beam = beam}, batch);
    sample.insert(sample.end(), batch.begin(), batch.end());
  }
  return sample;
}

TEST(Gaussian, MillionSamplesHaveMeanZeroAndVarianceOne) {
  const std::vector<double> sample = million();
  const auto n = static_cast<double>(sample.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double x : sample) {
    sum += x;
    squares += x * x;
  }
  constexpr double kSigmas = 4.0;
  EXPECT_LT(std::abs(sum / n), kSigmas / std::sqrt(n));
  EXPECT_LT(std::abs(squares / n - 1.0), kSigmas * std::sqrt(2.0 / n));  // variance of x^2 is 2
}

TEST(Gaussian, MillionSamplesPassTheKolmogorovSmirnovTest) {
  std::vector<double> sample = million();
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double theory = 0.5 * std::erfc(-sample[i] / std::numbers::sqrt2);
    const auto below = static_cast<double>(i) / n;
    farthest = std::max({farthest, std::abs(theory - below), std::abs(theory - below - 1.0 / n)});
  }
  constexpr double kOneInTenThousand = 2.23;  // quantile of Kolmogorov's distribution
  EXPECT_LT(farthest, kOneInTenThousand / std::sqrt(n));
}

}  // namespace

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
