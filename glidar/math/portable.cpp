// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/portable.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/double_double.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

namespace glidar {
namespace {

constexpr DoubleDouble kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr DoubleDouble kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

/// The nearest whole number to x, below 2^51: much faster than std::floor(), often a call.
struct Rounded {
  double value;
  std::uint64_t low_bits;
};

Rounded nearest_whole(double x) {
  constexpr double kUnit = 0x1.8p52;  // its neighbours are whole numbers
  const double shifted = x + kUnit;
  return {shifted - kUnit, std::bit_cast<std::uint64_t>(shifted)};
}

/// x minus the nearest whole number of quarter turns.
DoubleDouble rest_of_quarters(double x, double quarters) {
  constexpr double kMaxExact = 0x1p20;  // the products with the first two parts are exact
  constexpr double kPart0 = 0x1.921fb544p+0;
  constexpr double kPart1 = 0x1.0b4611a6p-34;
  constexpr double kPart2 = 0x1.3198a2e037073p-69;
  if (!(std::abs(x) < kMaxExact)) return DoubleDouble(x) - kHalfPi * quarters;
  const DoubleDouble first = exact_sum(x - quarters * kPart0, -quarters * kPart1);
  const double second = first.low - quarters * kPart2;
  return exact_sum(first.high, second);
}

/// The arctangents of whole eighths, rounded, and their rounding errors.
constexpr std::array<DoubleDouble, 9> kAtanEighths = {{
    {0.0, 0.0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};

/// The arctangent of t from 0 to 1. With c the nearest eighth, it is
/// atan c + atan((t - c) / (1 + c t)), and the series to the 13th power is exact to 2^-60.
DoubleDouble atan_of_fraction(double t) {
  const double eighths = nearest_whole(8.0 * t).value;
  const double c = 0.125 * eighths;
  const double r = (t - c) / (1.0 + c * t);
  const double q = r * r;
  double sum = 1.0 / 13.0;
  sum = sum * q - 1.0 / 11.0;
  sum = sum * q + 1.0 / 9.0;
  sum = sum * q - 1.0 / 7.0;
  sum = sum * q + 1.0 / 5.0;
  sum = sum * q - 1.0 / 3.0;
  const DoubleDouble& table = kAtanEighths[static_cast<std::size_t>(eighths)];
  const DoubleDouble angle = exact_sum(table.high, r);
  return {angle.high, angle.low + (table.low + r * q * sum)};
}

/// a - b, rounded once.
double rounded_difference(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = exact_sum(a.high, -b.high);
  return high.high + (high.low + (a.low - b.low));
}

}  // namespace

SineCosine portable_sincos(double x) {
  constexpr double kQuarterPi = 0.25 * std::numbers::pi;
  constexpr double kMax = 0x1p45;
  if (x == 0.0) return {x, 1.0};  // common, and keeps the sign
  if (std::abs(x) <= kQuarterPi) return sincos_taylor(x);
  const double held = std::abs(x) < kMax ? x : std::fmod(x, kTwoPi);
  const Rounded quarters = nearest_whole(held * (2.0 * std::numbers::inv_pi));
  const DoubleDouble rest = rest_of_quarters(held, quarters.value);
  const SineCosine high = sincos_taylor(rest.high);
  const double sine = high.sine + rest.low * high.cosine;
  const double cosine = high.cosine - rest.low * high.sine;
  const bool swapped = (quarters.low_bits & 1U) != 0;
  const bool is_half = (quarters.low_bits & 2U) != 0;
  const double first = swapped ? cosine : sine;
  const double second = swapped ? -sine : cosine;
  return {is_half ? -first : first, is_half ? -second : second};
}

double portable_sin(double x) {
  return portable_sincos(x).sine;
}

double portable_cos(double x) {
  return portable_sincos(x).cosine;
}

double portable_tan(double x) {
  const SineCosine angle = portable_sincos(x);
  return angle.sine / angle.cosine;
}

double portable_atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNaN;
  const double across = std::abs(y);
  const double along = std::abs(x);
  const double larger = across > along ? across : along;
  const double smaller = across > along ? along : across;
  double fraction = larger == 0.0 ? 0.0 : smaller / larger;
  if (std::isinf(larger)) fraction = std::isinf(smaller) ? 1.0 : 0.0;
  DoubleDouble angle = atan_of_fraction(fraction);
  double rounded = angle.high + angle.low;
  if (across > along) {
    rounded = rounded_difference(kHalfPi, angle);
    angle = {rounded, (kHalfPi - angle - rounded).high};
  }
  if (std::signbit(x)) rounded = rounded_difference(kPi, angle);
  return std::copysign(rounded, y);
}

double portable_atan(double x) {
  return portable_atan2(x, 1.0);
}

double portable_asin(double x) {
  return portable_atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}

double portable_acos(double x) {
  return portable_atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

double portable_hypot(double x, double y) {
  const double larger = std::max(std::abs(x), std::abs(y));
  if (std::isinf(x) || std::isinf(y)) return kInfinity;
  if (std::isnan(x) || std::isnan(y) || larger == 0.0) return x * x + y * y;
  const int exponent = std::ilogb(larger);
  const double a = std::ldexp(x, -exponent);
  const double b = std::ldexp(y, -exponent);
  return std::ldexp(std::sqrt(a * a + b * b), exponent);
}

double portable_cbrt(double x) {
  if (x == 0.0 || !std::isfinite(x)) return x;
  const int thirds = static_cast<int>(std::floor(std::ilogb(x) / 3.0));
  const double part = std::ldexp(std::abs(x), -3 * thirds);  // from 1 to 8
  double root = portable_exp(portable_log(part) / 3.0);
  const DoubleDouble square = exact_product(root, root);
  root -= (square * root - part).high / (3.0 * square.high);
  return std::copysign(std::ldexp(root, thirds), x);
}

double portable_erfc(double x) {
  constexpr std::array kSeries = {
      -0.6513268598908547,     0.6419697923564902,      0.019476473204185836,
      -0.009561514786808632,   -0.0009465953444820369,  0.00036683949785276145,
      4.252332480690777e-05,   -2.0278578112534242e-05, -1.6242900046470256e-06,
      1.3036558355805232e-06,  1.5626441722066142e-08,  -8.523809591492654e-08,
      6.5290544390988515e-09,  5.059343495551469e-09,   -9.91364156493033e-10,
      -2.273651222931836e-10,  9.646791102015527e-11,   2.394038083039113e-12,
      -6.886027526497552e-12,  8.944879273090707e-13,   3.130921399342977e-13,
      -1.1270822361367437e-13, 3.810905255207432e-16,   7.106097613607442e-15,
      -1.5230282014553353e-15, -9.457494571465448e-17,  1.2102371892414214e-16,
      -2.816663087915714e-17,  5.0030057250036066e-20,  2.3281042563280633e-18};
  constexpr double kZeroFrom = 27.0;  // erfc(27) is 5e-319
  if (std::isnan(x)) return x;
  const double size = std::min(std::abs(x), kZeroFrom);
  const double t = 2.0 / (2.0 + size);
  const double twice = 2.0 * (2.0 * t - 1.0);
  double next = 0.0;  // Clenshaw's recurrence
  double sum = 0.0;
  for (std::size_t k = kSeries.size() - 1; k > 0; --k) {
    const double before = twice * sum - next + kSeries[k];
    next = sum;
    sum = before;
  }
  const double logarithm = 0.5 * twice * sum - next + kSeries[0];
  const double value = std::abs(x) < kZeroFrom ? t * portable_exp(logarithm - size * size) : 0.0;
  return x < 0.0 ? 2.0 - value : value;
}

double normal_probability(double x) {
  return 0.5 * portable_erfc(-x / std::numbers::sqrt2);
}

double normal_quantile(double probability) {
  if (probability > 0.5) return -normal_quantile(1.0 - probability);
  if (!(probability > 0.0)) return probability == 0.0 ? -kInfinity : kNaN;
  const double t = std::sqrt(-2.0 * portable_log(probability));
  double x = (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) -
             t;
  for (int step = 0; step < 2; ++step) {
    const double density = portable_exp(-0.5 * x * x) / std::sqrt(kTwoPi);
    const double correction = (normal_probability(x) - probability) / density;
    x -= correction / (1.0 + 0.5 * x * correction);
  }
  return x;
}

double portable_log2(double x) {
  return portable_log(x) * std::numbers::log2e;
}

double power_of_ten(int exponent) {
  const std::string text = "1e" + std::to_string(exponent);
  double value = exponent < 0 ? 0.0 : kInfinity;  // from_chars() keeps it out of range
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

int decimal_exponent(double x) {
  const int nearby = static_cast<int>(std::floor(portable_log(x) * std::numbers::log10e));
  if (power_of_ten(nearby + 1) <= x) return nearby + 1;
  return power_of_ten(nearby) <= x ? nearby : nearby - 1;
}

}  // namespace glidar
