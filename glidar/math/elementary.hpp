// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Elementary functions from + - * / and bit operations only, so that results are bit-identical on
// any machine (those of the C library differ between versions). They have no branches, so loops
// over them vectorise. Absolute errors are below 1e-14 where the result is below 10.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace glidar {

/// Converts an integer below 2^52 by its bits: not every instruction set converts 64-bit integers.
inline double whole_to_double(std::uint64_t whole) {
  constexpr std::uint64_t kBits = 0x4330000000000000U;  // of 2^52
  return std::bit_cast<double>(whole | kBits) - 0x1p52;
}

/// ln x for normal numbers x > 0. With x = m 2^e, m in [1/sqrt 2, sqrt 2), it is
/// e ln 2 + 2 artanh s, s = (m - 1) / (m + 1), and the series of artanh to s^21
/// (Abramowitz and Stegun 4.6.22), whose next term is below 1e-18.
inline double portable_log(double x) {
  constexpr std::uint64_t kOne = 0x3FF0000000000000U;
  constexpr std::uint64_t kRootHalf = 0x3FE6A09E667F3BCDU;  // of 1 / sqrt 2
  constexpr std::uint64_t kFraction = 0x000FFFFFFFFFFFFFU;
  const std::uint64_t shifted = std::bit_cast<std::uint64_t>(x) + (kOne - kRootHalf);
  const double exponent = whole_to_double(shifted >> 52U) - 1023.0;
  const auto mantissa = std::bit_cast<double>((shifted & kFraction) + kRootHalf);
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  const double q = s * s;
  double sum = 1.0 / 21.0;
  sum = sum * q + 1.0 / 19.0;
  sum = sum * q + 1.0 / 17.0;
  sum = sum * q + 1.0 / 15.0;
  sum = sum * q + 1.0 / 13.0;
  sum = sum * q + 1.0 / 11.0;
  sum = sum * q + 1.0 / 9.0;
  sum = sum * q + 1.0 / 7.0;
  sum = sum * q + 1.0 / 5.0;
  sum = sum * q + 1.0 / 3.0;
  // ln 2 in two parts, the first short enough that its product with the exponent is exact
  constexpr double kHigh = 0x1.62e42feep-1;
  constexpr double kLow = 0x1.a39ef35793c76p-33;
  return exponent * kHigh + (2.0 * s + (2.0 * s * q * sum + exponent * kLow));
}

struct SineCosine {
  double sine;
  double cosine;
};

/// Sine and cosine for |x| <= pi/4 (radians), by their Taylor series to x^17 and x^16.
inline SineCosine sincos_taylor(double x) {
  const double q = x * x;
  double sine = 1.0 / 355687428096000.0;  // 1 / 17!
  sine = sine * q - 1.0 / 1307674368000.0;
  sine = sine * q + 1.0 / 6227020800.0;
  sine = sine * q - 1.0 / 39916800.0;
  sine = sine * q + 1.0 / 362880.0;
  sine = sine * q - 1.0 / 5040.0;
  sine = sine * q + 1.0 / 120.0;
  sine = sine * q - 1.0 / 6.0;
  double cosine = 1.0 / 20922789888000.0;  // 1 / 16!
  cosine = cosine * q - 1.0 / 87178291200.0;
  cosine = cosine * q + 1.0 / 479001600.0;
  cosine = cosine * q - 1.0 / 3628800.0;
  cosine = cosine * q + 1.0 / 40320.0;
  cosine = cosine * q - 1.0 / 720.0;
  cosine = cosine * q + 1.0 / 24.0;
  cosine = cosine * q - 1.0 / 2.0;
  return {x + x * q * sine, 1.0 + q * cosine};
}

/// Sine and cosine of an angle in turns (1 = 2 pi), for |turns| < 2^48.
inline SineCosine sincos_turns(double turns) {
  const double quarters = turns * 4.0;
  const double whole = std::floor(quarters + 0.5);
  const SineCosine part = sincos_taylor((quarters - whole) * (std::numbers::pi / 2.0));
  const double quadrant = whole - 4.0 * std::floor(whole * 0.25);
  const bool swapped = quadrant == 1.0 || quadrant == 3.0;
  const double sine = swapped ? part.cosine : part.sine;
  const double cosine = swapped ? part.sine : part.cosine;
  return {quadrant >= 2.0 ? -sine : sine, quadrant == 1.0 || quadrant == 2.0 ? -cosine : cosine};
}

/// The angle of the vector (x, y) in turns, in [0, 1); 0 for the zero vector. The ratio of the
/// smaller to the larger coordinate is reduced twice by tan(a - b) = (tan a - tan b) /
/// (1 + tan a tan b), with b = pi/8 and then pi/16, before one division. The series of the
/// arctangent goes to t^21.
inline double atan2_turns(double y, double x) {
  const double ax = std::abs(x);
  const double ay = std::abs(y);
  const double larger = ax > ay ? ax : ay;
  const double smaller = ax > ay ? ay : ax;
  constexpr double kTan16 = 0.19891236737965800691;  // tan(pi / 16)
  constexpr double kTan8 = 0.41421356237309504880;   // tan(pi / 8)
  const bool far = smaller > kTan8 * larger;
  const double rise = far ? smaller - kTan8 * larger : smaller;
  const double run = far ? larger + kTan8 * smaller : larger;
  const bool half = rise > kTan16 * run;
  const double rest = half ? rise - kTan16 * run : rise;
  const double whole = half ? run + kTan16 * rise : run;
  const double t = larger > 0.0 ? rest / whole : 0.0;
  const double q = t * t;
  double sum = 1.0 / 21.0;
  sum = sum * q - 1.0 / 19.0;
  sum = sum * q + 1.0 / 17.0;
  sum = sum * q - 1.0 / 15.0;
  sum = sum * q + 1.0 / 13.0;
  sum = sum * q - 1.0 / 11.0;
  sum = sum * q + 1.0 / 9.0;
  sum = sum * q - 1.0 / 7.0;
  sum = sum * q + 1.0 / 5.0;
  sum = sum * q - 1.0 / 3.0;
  double turns = (t + t * q * sum) * (0.5 * std::numbers::inv_pi);
  turns += (far ? 1.0 / 16.0 : 0.0) + (half ? 1.0 / 32.0 : 0.0);
  turns = ay > ax ? 0.25 - turns : turns;
  turns = x < 0.0 ? 0.5 - turns : turns;
  turns = y < 0.0 ? 1.0 - turns : turns;
  return turns < 1.0 ? turns : 0.0;
}

/// e^x = 2^k e^r with |r| <= ln 2 / 2, and the series of e^r to r^14. 0 for x < -700, infinity for
/// x > 700.
inline double portable_exp(double x) {
  constexpr double kMax = 700.0;
  const double held = x > -kMax ? (x < kMax ? x : kMax) : -kMax;
  const double whole = std::floor(held * std::numbers::log2e + 0.5);
  constexpr double kHigh = 0x1.62e42feep-1;
  constexpr double kLow = 0x1.a39ef35793c76p-33;
  const double r = (held - whole * kHigh) - whole * kLow;
  double sum = 1.0 / 87178291200.0;  // 1 / 14!
  sum = sum * r + 1.0 / 6227020800.0;
  sum = sum * r + 1.0 / 479001600.0;
  sum = sum * r + 1.0 / 39916800.0;
  sum = sum * r + 1.0 / 3628800.0;
  sum = sum * r + 1.0 / 362880.0;
  sum = sum * r + 1.0 / 40320.0;
  sum = sum * r + 1.0 / 5040.0;
  sum = sum * r + 1.0 / 720.0;
  sum = sum * r + 1.0 / 120.0;
  sum = sum * r + 1.0 / 24.0;
  sum = sum * r + 1.0 / 6.0;
  sum = sum * r + 1.0 / 2.0;
  sum = 1.0 + (r + r * r * sum);
  // The integer's bits by an addition: not every instruction set converts 64-bit integers.
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(whole + 0x1.8p52) + 1023U;
  const double result = sum * std::bit_cast<double>(exponent << 52U);
  const double bounded = x > kMax ? std::numeric_limits<double>::infinity() : result;
  return x < -kMax ? 0.0 : bounded;
}

/// base^exponent for a normal base > 0, or base 0 with exponent >= 0. The relative error is below
/// 3e-16 (1 + |exponent ln base|).
inline double portable_pow(double base, double exponent) {
  const double raised = portable_exp(exponent * portable_log(base));
  const double from_zero = base > 0.0 ? raised : 0.0;
  return exponent == 0.0 ? 1.0 : from_zero;
}

}  // namespace glidar
