// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/elliptic.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kRounding = 4e-15;  // relative; a dozen roundings

TEST(Elliptic, CarlsonsIntegralsHaveHisPublishedValues) {
  // Carlson, "Numerical computation of real or complex elliptic integrals" (1995), section 3
  EXPECT_NEAR(carlson_rf(1.0, 2.0, 0.0), 1.3110287771461, 5e-14);
  EXPECT_NEAR(carlson_rf(2.0, 3.0, 4.0), 0.58408284167715, 5e-15);
  EXPECT_NEAR(carlson_rj(0.0, 1.0, 2.0, 3.0), 0.77688623778582, 5e-15);
  EXPECT_NEAR(carlson_rj(2.0, 3.0, 4.0, 5.0), 0.14297579667157, 5e-15);
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

TEST(Elliptic, IncompleteIntegralsAgreeWithTheStandardLibrary) {
  for (const double m : {0.1, 0.5, 0.9}) {
    const EllipticModulus modulus = make_modulus(m, 1.0 - m);
    for (double angle = -1.5; angle < 1.6; angle += 0.25) {
      const double u = std::ellint_1(std::sqrt(m), angle);
      EXPECT_NEAR(elliptic_f(modulus, std::sin(angle), std::cos(angle)), u, 1e-13);
      // the standard library's sign of n is the same as here
      for (const double n : {-0.2, -3.0}) {
        EXPECT_NEAR(elliptic_pi(modulus, n, u), std::ellint_3(std::sqrt(m), n, angle), 1e-12);
      }
    }
  }
}

TEST(Elliptic, ThirdIntegralIsThatOfItsIntegrandOverManyPeriods) {
  const EllipticModulus modulus = make_modulus(0.6, 0.4);
  const double n = -1.7;
  const double end = 23.0;
  // Simpson's rule: the error of 20000 smooth steps is below rounding
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double sn = jacobi(modulus, end * i / kSteps).sn;
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight / (1.0 - n * sn * sn);
  }
  EXPECT_NEAR(elliptic_pi(modulus, n, end), sum * end / kSteps / 3.0, 1e-11);
}

}  // namespace
}  // namespace glidar
