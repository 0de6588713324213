// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Functions of which the C library's results differ between its versions and between processors,
// from + - * / and square roots only: the same bits on any machine. Errors are in units in the last
// place (ulp) of the result, the largest that tests/math/portable_test.cpp found. Special values
// (zeros, infinities, NaN) are those of the C library.

#include <glidar/math/elementary.hpp>

namespace glidar {

/// Sine and cosine of x radians within 1.5 ulp for |x| < 2^20 (Cody and Waite, "Software Manual for
/// the Elementary Functions", 1980, with pi/2 in three parts), and within 2^-52 up to 2^45. Larger
/// numbers, with more than 0.004 rad between them, are first reduced by fmod(x, 2 pi).
SineCosine portable_sincos(double x);
double portable_sin(double x);
double portable_cos(double x);

/// Sine by cosine, within 3.5 ulp.
double portable_tan(double x);

/// The angle of the vector (x, y) in radians, from -pi to pi, within 2 ulp: the arctangent of the
/// nearest eighth, from a table, and the series for the rest.
double portable_atan2(double y, double x);
double portable_atan(double x);

/// By the arctangent, within 3 ulp.
double portable_asin(double x);
double portable_acos(double x);

/// sqrt(x^2 + y^2) within 1.5 ulp, without overflow of the squares.
double portable_hypot(double x, double y);

/// The cube root, by Newton's method, within 1 ulp.
double portable_cbrt(double x);

/// The complement of the error function with a relative error below 3e-16 (5 + x^2), up to 26:
/// Chebyshev series of ln(erfc(x) exp(x^2) (1 + x/2)) by 2 / (2 + x) (Press et al., "Numerical
/// Recipes", 3rd edition, 6.2.2), with coefficients computed to 60 digits.
double portable_erfc(double x);

/// The distribution function of standard normal numbers, by portable_erfc().
double normal_probability(double x);

/// Its inverse, for probabilities from 0 to 1: Abramowitz and Stegun 26.2.23, then two steps of
/// Halley's method. The probability of the result is exact to a relative error of 1e-14.
double normal_quantile(double probability);

/// The logarithm to base 2 within 3 ulp, from portable_log().
double portable_log2(double x);

/// 10^exponent, correctly rounded.
double power_of_ten(int exponent);

/// The exponent of the largest power of ten up to x, a normal number above 0: -1 of 0.1, 3 of 1000.
int decimal_exponent(double x);

}  // namespace glidar
