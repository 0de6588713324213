// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/math/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace glidar {
namespace {

// The reference is the C library in long double, which has at least 11 bits more.
using Exact = long double;

struct Case {
  const char* name;
  double (*own)(double);
  Exact (*exact)(Exact);
  double from;
  double to;
  double max_ulp;
  bool is_logarithmic = false;
};

void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.name << " from " << tested.from << " to " << tested.to;
}

/// The error of a result in units of its last place.
double ulps(double found, Exact exact) {
  const int exponent = std::ilogb(static_cast<double>(exact));
  return static_cast<double>(std::abs(found - exact) / std::ldexp(Exact{1}, exponent - 52));
}

constexpr std::uint32_t kNumbers = 40000;

/// Random arguments between two numbers, evenly or by their logarithm.
std::vector<double> arguments(double from, double to, bool is_logarithmic) {
  std::vector<double> found;
  for (std::uint32_t i = 0; i < kNumbers; ++i) {
    const double share = uniform(random_words({.seed = 7, .beam = i})[0]);
    found.push_back(is_logarithmic ? from * std::pow(to / from, share)
                                   : from + share * (to - from));
  }
  return found;
}

class PortableFunction : public ::testing::TestWithParam<Case> {};

TEST_P(PortableFunction, IsAsExactAsStated) {
  const Case& tested = GetParam();
  for (const double x : arguments(tested.from, tested.to, tested.is_logarithmic)) {
    ASSERT_LE(ulps(tested.own(x), tested.exact(x)), tested.max_ulp) << tested.name << " of " << x;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, PortableFunction,
    ::testing::Values(Case{"sine", portable_sin, std::sin, -7.0, 7.0, 1.5},
                      Case{"sine", portable_sin, std::sin, 1e-9, 1e6, 1.5, true},
                      Case{"cosine", portable_cos, std::cos, -7.0, 7.0, 1.5},
                      Case{"cosine", portable_cos, std::cos, 1e-9, 1e6, 1.5, true},
                      Case{"tangent", portable_tan, std::tan, -1.57, 1.57, 3.5},
                      Case{"tangent", portable_tan, std::tan, -100.0, 100.0, 3.5},
                      Case{"arctangent", portable_atan, std::atan, -20.0, 20.0, 2.0},
                      Case{"arctangent", portable_atan, std::atan, 1e-9, 1e9, 2.0, true},
                      Case{"arcsine", portable_asin, std::asin, -1.0, 1.0, 3.0},
                      Case{"arcsine", portable_asin, std::asin, 1e-9, 1.0, 3.0, true},
                      Case{"arccosine", portable_acos, std::acos, -1.0, 1.0, 3.0},
                      Case{"cube root", portable_cbrt, std::cbrt, 1e-150, 1e150, 1.0, true},
                      Case{"cube root", portable_cbrt, std::cbrt, -8.0, -1.0, 1.0},
                      Case{"logarithm to base 2", portable_log2, std::log2, 1e-3, 1e3, 3.0, true},
                      Case{"exponential", portable_exp, std::exp, -40.0, 40.0, 1.0},
                      Case{"logarithm", portable_log, std::log, 1e-9, 1e9, 2.0, true}));

TEST(Portable, SineAndCosineAreExactNearMultiplesOfAQuarterTurn) {
  for (int k = -3000; k <= 3000; ++k) {
    if (k == 0) continue;
    const double x = 0.5 * std::numbers::pi * k;
    const SineCosine found = portable_sincos(x);
    EXPECT_LE(ulps(found.sine, std::sin(Exact{x})), 1.5) << k;
    EXPECT_LE(ulps(found.cosine, std::cos(Exact{x})), 1.5) << k;
  }
}

TEST(Portable, SineAndCosineOfLargeAnglesAreExactToARounding) {
  for (const double x : arguments(0x1p20, 0x1p45, true)) {
    EXPECT_NEAR(portable_sin(x), static_cast<double>(std::sin(Exact{x})), 0x1p-51) << x;
    EXPECT_NEAR(portable_cos(x), static_cast<double>(std::cos(Exact{x})), 0x1p-51) << x;
  }
  for (const double x : {0x1p45, -1e20, 1e300}) {
    const SineCosine found = portable_sincos(x);
    EXPECT_NEAR(found.sine * found.sine + found.cosine * found.cosine, 1.0, 1e-15) << x;
  }
}

TEST(Portable, AngleOfAVectorIsExactInAllQuadrants) {
  for (const double y : arguments(-10.0, 10.0, false)) {
    for (const double x : {-3.0, -0.01, 0.3, 7.0}) {
      ASSERT_LE(ulps(portable_atan2(y, x), std::atan2(Exact{y}, Exact{x})), 2.0) << y << " " << x;
      ASSERT_LE(ulps(portable_hypot(y, x), std::hypot(Exact{y}, Exact{x})), 1.5) << y << " " << x;
    }
  }
}

TEST(Portable, ComplementOfTheErrorFunctionIsExact) {
  for (const double x : arguments(-6.0, 26.0, false)) {
    const Exact exact = std::erfc(Exact{x});
    ASSERT_LE(std::abs(portable_erfc(x) - exact), 3e-16 * (5.0 + x * x) * exact) << x;
  }
  EXPECT_EQ(portable_erfc(30.0), 0.0);
  EXPECT_EQ(portable_erfc(-kInfinity), 2.0);
  EXPECT_TRUE(std::isnan(portable_erfc(kNaN)));
}

TEST(Portable, QuantilesOfTheNormalDistributionInvertIt) {
  for (const double p : arguments(1e-290, 0.5, true)) {
    EXPECT_NEAR(0.5 * std::erfc(-normal_quantile(p) / std::numbers::sqrt2) / p, 1.0, 1e-12) << p;
    EXPECT_EQ(normal_quantile(1.0 - p), -normal_quantile(1.0 - (1.0 - p)));
  }
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-15);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_EQ(normal_quantile(0.0), -kInfinity);
  EXPECT_EQ(normal_quantile(1.0), kInfinity);
  EXPECT_TRUE(std::isnan(normal_quantile(kNaN)));
  EXPECT_NEAR(normal_probability(-1.0), 0.15865525393145705, 1e-16);
}

/// Equal including the sign of zero, or both NaN.
void expect_same(double found, double expected, const std::string& what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(found)) << what;
  } else {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(expected)) << what;
  }
}

TEST(Portable, SpecialValuesAreThoseOfTheLibrary) {
  const std::vector<double> special = {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, kNaN};
  for (const double y : special) {
    for (const double x : special) {
      const std::string what = std::to_string(y) + ", " + std::to_string(x);
      expect_same(portable_atan2(y, x), std::atan2(y, x), "atan2 " + what);
      if (!std::isnan(y) && !std::isnan(x)) {
        expect_same(portable_hypot(y, x), std::hypot(y, x), "hypot " + what);
      }
    }
    const std::string what = std::to_string(y);
    expect_same(portable_asin(y), std::asin(y), "asin " + what);
    expect_same(portable_acos(y), std::acos(y), "acos " + what);
    expect_same(portable_cbrt(y), std::cbrt(y), "cbrt " + what);
    if (std::abs(y) == 1.0) continue;
    expect_same(portable_sin(y), std::sin(y), "sin " + what);
    expect_same(portable_cos(y), std::cos(y), "cos " + what);
    expect_same(portable_tan(y), std::tan(y), "tan " + what);
  }
  EXPECT_EQ(portable_hypot(3e300, 4e300), 5e300);
  EXPECT_EQ(portable_hypot(3e-320, 4e-320), 5e-320);
}

TEST(Portable, PowersOfTenAreExactAndTheirExponentsAreFound) {
  EXPECT_EQ(power_of_ten(-5), 1e-5);
  EXPECT_EQ(power_of_ten(23), 1e23);
  EXPECT_EQ(power_of_ten(400), kInfinity);
  EXPECT_EQ(power_of_ten(-400), 0.0);
  for (int exponent = -300; exponent <= 300; ++exponent) {
    const double power = power_of_ten(exponent);
    EXPECT_EQ(decimal_exponent(power), exponent);
    EXPECT_EQ(decimal_exponent(std::nextafter(power, 0.0)), exponent - 1);
    EXPECT_EQ(decimal_exponent(9.99 * power), exponent);
  }
}

/// FNV-1a over the bytes of the results.
std::uint64_t hash_of(double (*function)(double), double from, double to) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (int i = 0; i <= 10000; ++i) {
    auto bits = std::bit_cast<std::uint64_t>(function(from + (to - from) * i / 10000.0));
    for (int byte = 0; byte < 8; ++byte, bits >>= 8U)
      hash = (hash ^ (bits & 0xFFU)) * 0x100000001b3U;
  }
  return hash;
}

TEST(Portable, ResultsHaveTheRecordedBytes) {
  EXPECT_EQ(hash_of(portable_sin, -100.0, 100.0), 5875031749288788337U);
  EXPECT_EQ(hash_of(portable_cos, -1e9, 1e9), 3791957008093324264U);
  EXPECT_EQ(hash_of(portable_tan, -10.0, 10.0), 2958889735834534096U);
  EXPECT_EQ(hash_of(portable_atan, -10.0, 10.0), 17208764781274235604U);
  EXPECT_EQ(hash_of(portable_asin, -1.0, 1.0), 2361245952550574914U);
  EXPECT_EQ(hash_of(portable_acos, -1.0, 1.0), 16467394923431876914U);
  EXPECT_EQ(hash_of(portable_cbrt, -10.0, 10.0), 11230838527257135281U);
  EXPECT_EQ(hash_of(portable_erfc, -6.0, 26.0), 17885462926938886427U);
  EXPECT_EQ(hash_of(portable_exp, -50.0, 50.0), 13690733606626188939U);
  EXPECT_EQ(hash_of(portable_log, 1e-3, 1e3), 13208512268144667704U);
}

}  // namespace
}  // namespace glidar
