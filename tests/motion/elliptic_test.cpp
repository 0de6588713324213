// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/torque_free_rotation.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

TEST(IntegralTable, IntegratesSmoothFunctionsToRounding) {
  // the pole nearest to the real axis is at a distance of pi / 2, as that of sech
  const auto sech = [](double x) { return 1.0 / std::cosh(x); };
  for (const double end : {0.1, 1.0, 1.7, 40.3}) {
    const IntegralTable table(end, FunctionRef<double(double)>(sech));
    for (int k = 0; k <= 100; ++k) {
      const double x = end * k / 100;
      EXPECT_NEAR(table.at(x), std::atan(std::sinh(x)), 2e-15) << end << " " << x;
    }
    EXPECT_NEAR(table.total(), std::atan(std::sinh(end)), 2e-15);
  }
}

TEST(IntegralTable, IsZeroAtTheStart) {
  const auto one = [](double) { return 1.0; };
  EXPECT_NEAR(IntegralTable(3.0, FunctionRef<double(double)>(one)).at(0.0), 0.0, 1e-16);
}

}  // namespace

namespace {

constexpr double kRounding = 4e-15;  // relative; a dozen roundings

TEST(Elliptic, CarlsonsIntegralHasThePublishedValues) {
  // Carlson, "Numerical computation of real or complex elliptic integrals" (1995), section 3
  EXPECT_NEAR(carlson_rf(1.0, 2.0, 0.0), 1.3110287771461, 5e-14);
  EXPECT_NEAR(carlson_rf(2.0, 3.0, 4.0), 0.58408284167715, 5e-15);
}

TEST(Elliptic, CompleteIntegralAgreesWithTheStandardLibrary) {
  for (const double m : {0.0, 0.01, 0.3, 0.5, 0.9, 0.99}) {
    const double expected = std::comp_ellint_1(std::sqrt(m));
    EXPECT_NEAR(make_modulus(m, 1.0 - m).quarter_period, expected, 1e-13 * expected) << m;
  }
}

TEST(Elliptic, QuarterPeriodNearOneIsTheLogarithm) {
  // K = ln(4 / sqrt(m1)) + O(m1 ln m1), Abramowitz & Stegun 17.3.26
  EXPECT_NEAR(make_modulus(1.0, 1e-30).quarter_period, std::log(4e15), 1e-13);
}

TEST(Elliptic, JacobiFunctionsInvertTheFirstIntegral) {
  for (const double m : {0.0, 0.2, 0.7, 0.999}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    for (double angle = -3.1; angle < 3.1; angle += 0.1) {
      const JacobiValues j = jacobi(modulus, elliptic_f(modulus, std::sin(angle), std::cos(angle)));
      EXPECT_NEAR(j.sn, std::sin(angle), kRounding * 10.0) << m << " " << angle;
      EXPECT_NEAR(j.cn, std::cos(angle), kRounding * 10.0) << m << " " << angle;
      EXPECT_NEAR(j.dn * j.dn, 1.0 - m * j.sn * j.sn, kRounding);
    }
  }
}

TEST(Elliptic, JacobiFunctionsHaveTheirLimits) {
  const EllipticModulus circle = make_modulus(0.0, 1.0);
  const EllipticModulus separatrix = make_modulus(1.0, 1e-30);
  for (double u = -5.0; u < 5.0; u += 0.37) {
    EXPECT_NEAR(jacobi(circle, u).sn, std::sin(u), kRounding);
    // the mean takes more steps there, each with its rounding
    EXPECT_NEAR(jacobi(separatrix, u).sn, std::tanh(u), 5.0 * kRounding);
    EXPECT_NEAR(jacobi(separatrix, u).cn, 1.0 / std::cosh(u), 5.0 * kRounding);
    EXPECT_NEAR(jacobi(separatrix, u).dn, 1.0 / std::cosh(u), 5.0 * kRounding);
  }
}

TEST(Elliptic, FirstIntegralAgreesWithTheStandardLibrary) {
  for (const double m : {0.1, 0.5, 0.9}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    for (double angle = -1.5; angle < 1.6; angle += 0.25) {
      const double u = std::ellint_1(std::sqrt(m), angle);
      EXPECT_NEAR(elliptic_f(modulus, std::sin(angle), std::cos(angle)), u, 1e-13);
    }
  }
}

// Relative, where cn and dn are as small as sqrt(1 - m):
// cn(K + x) = -k' sn / dn, dn(K + x) = k' / dn (DLMF 22.4(iii)), with tanh and sech for m near 1.
TEST(Elliptic, SmallValuesKeepTheirRelativePrecision) {
  for (const double complement : {1e-40, 1e-80, 1e-250}) {
    const EllipticModulus modulus = make_modulus(1.0, complement);
    const double root = std::sqrt(complement);
    const double quarter = modulus.quarter_period;
    for (const double x : {0.5, 1.0, 3.0, 10.0}) {
      // the quarter period itself is rounded
      const double tolerance = 1e-13 + quarter * 1e-15;
      const JacobiValues j = jacobi(modulus, quarter + x);
      EXPECT_NEAR(j.cn / (-root * std::sinh(x)), 1.0, tolerance) << complement << " " << x;
      EXPECT_NEAR(j.dn / (root * std::cosh(x)), 1.0, tolerance) << complement << " " << x;
    }
  }
}

TEST(Elliptic, FunctionsArePeriodic) {
  for (const double m : {0.0, 0.3, 0.500001, 0.97}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    const double period = 4.0 * modulus.quarter_period;
    for (double u = -3.0; u < 3.0; u += 0.31) {
      const JacobiValues one = jacobi(modulus, u);
      const JacobiValues far = jacobi(modulus, u + 25.0 * period);
      // of arguments up to 300, rounded
      EXPECT_NEAR(one.sn, far.sn, 1e-13);
      EXPECT_NEAR(one.cn, far.cn, 1e-13);
      EXPECT_NEAR(one.dn, far.dn, 1e-13);
      EXPECT_NEAR(one.sn * one.sn + one.cn * one.cn, 1.0, kRounding);
    }
  }
}

}  // namespace
}  // namespace glidar
