// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/elliptic.hpp>

#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace glidar {
namespace {

/// Clenshaw's recurrence: the sum of c_k T_k(t).
template <std::size_t N>
double chebyshev_sum(const std::array<double, N>& c, double t) {
  double next = 0.0;
  double after = 0.0;
  for (std::size_t k = N - 1; k > 0; --k) {
    const double now = 2.0 * t * next - after + c[k];
    after = next;
    next = now;
  }
  return t * next - after + c[0];
}

/// Coefficients of a function's Chebyshev series, the first twice its own, from its values at the
/// nodes cos(pi (j + 1/2) / N); two more that are 0.
template <std::size_t N>
std::array<double, N + 2> chebyshev_series(const std::array<double, N>& values) {
  std::array<double, N + 2> series{};
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t j = 0; j < N; ++j) {
      const double turns = static_cast<double>(k * (2 * j + 1)) / (4.0 * N);
      series[k] += 2.0 / N * values[j] * sincos_turns(turns).cosine;
    }
  }
  return series;
}

}  // namespace

IntegralTable::IntegralTable(double end, FunctionRef<double(double)> function) {
  const double count = std::max(1.0, std::ceil(end));
  const double length = end / count;
  per_segment_ = count / end;
  for (double start = 0.0; start < count; start += 1.0) {
    std::array<double, kNodes> values{};
    for (std::size_t j = 0; j < kNodes; ++j) {
      const double place = sincos_turns((static_cast<double>(j) + 0.5) / (2.0 * kNodes)).cosine;
      values[j] = function(length * (start + 0.5 * (1.0 + place)));
    }
    add_segment(length, chebyshev_series(values));
  }
}

void IntegralTable::add_segment(double length, const std::array<double, kNodes + 2>& series) {
  Segment segment{};
  double at_start = 0.0;
  double to_end = 0.0;
  for (std::size_t k = 1; k <= kNodes; ++k) {
    segment[k] = 0.25 * length * (series[k - 1] - series[k + 1]) / static_cast<double>(k);
    at_start += k % 2 == 0 ? segment[k] : -segment[k];
    to_end += segment[k];
  }
  segment[0] = total_ - at_start;
  total_ += to_end - at_start;
  segments_.push_back(segment);
}

double IntegralTable::at(double x) const {
  const double place = x * per_segment_;
  const double last = static_cast<double>(segments_.size() - 1);
  const double segment = std::clamp(std::floor(place), 0.0, last);
  return chebyshev_sum(segments_[static_cast<std::size_t>(segment)], 2.0 * (place - segment) - 1.0);
}

namespace {

/// The arithmetic-geometric mean of 1 and a number in [0, 1]; 0 for 0.
double mean_with_one(double b) {
  constexpr double kRelative = 1e-9;  // each step squares the difference
  double a = 1.0;
  if (!(b > 0.0)) return 0.0;
  while (a - b > kRelative * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.5 * (a + b);
}

/// Theta functions at one argument, divided by common factors.
struct Thetas {
  double one = 0.0;
  double two = 0.0;
  double three = 1.0;
  double four = 1.0;
};

/// Number of terms of each series: for a nome of at most exp(-pi) and an argument of at most a
/// quarter of the period, the omitted terms are below 1e-19.
constexpr int kTerms = 4;

/// At z, where 2 pi z is the angle: DLMF 20.2(i), the first two divided by 2 q^(1/4).
Thetas circular_thetas(double q, double turns) {
  Thetas sums;
  double power = 1.0;   // q^(n (n + 1))
  double square = q;    // q^((n + 1)^2)
  double single = 1.0;  // q^n
  for (int n = 0; n < kTerms; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    const SineCosine odd = sincos_turns((2 * n + 1) * turns);
    const double even = 2.0 * sincos_turns(2 * (n + 1) * turns).cosine;
    sums.one += sign * power * odd.sine;
    sums.two += power * odd.cosine;
    sums.three += square * even;
    sums.four -= sign * square * even;
    single *= q;
    power *= single * single;
    square *= single * single * q;
  }
  return sums;
}

/// At i v: the first two divided by q^(1/4) e^|v|, the first by i too. With p = e^(-2 |v|) and
/// w = q / p the terms are w^n q^(n^2) (1 -+ p^(2n + 1)) and w^n q^(n^2 - n) (1 + p^(2n)).
Thetas hyperbolic_thetas(double q, double v) {
  const double p = portable_exp(-2.0 * std::abs(v));
  const double w = q / p;
  Thetas sums;
  double power = 1.0;   // w^n q^(n^2)
  double square = w;    // w^(n + 1) q^(n^2 + n)
  double single = 1.0;  // q^n
  double odd = p;       // p^(2n + 1)
  for (int n = 0; n < kTerms; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    const double even = square * (1.0 + odd * p);
    sums.one += sign * power * (1.0 - odd);
    sums.two += power * (1.0 + odd);
    sums.three += even;
    sums.four -= sign * even;
    power *= w * single * single * q;
    single *= q;
    square *= w * single * single;
    odd *= p * p;
  }
  sums.one = std::copysign(sums.one, v);
  return sums;
}

/// Within half a quarter period of 0.
JacobiValues jacobi_near_zero(const EllipticModulus& modulus, double u) {
  const double v = modulus.argument_scale * u;
  const JacobiValues& scale = modulus.scale;
  if (!modulus.is_hyperbolic) {  // DLMF 22.2.4 to 22.2.6
    const Thetas at = circular_thetas(modulus.nome, v * (0.5 * std::numbers::inv_pi));
    return {scale.sn * at.one / at.four, scale.cn * at.two / at.four,
            scale.dn * at.three / at.four};
  }
  // sn = -i sc, cn = nc, dn = dc at i u of the complement: DLMF 22.6.1
  const Thetas at = hyperbolic_thetas(modulus.nome, v);
  const double decay = portable_exp(-std::abs(v)) / at.two;
  return {scale.sn * at.one / at.two, scale.cn * decay * at.four, scale.dn * decay * at.three};
}

}  // namespace

EllipticModulus make_modulus(double m, double complement) {
  EllipticModulus modulus{.m = m, .complement = std::max(complement, kMinComplement)};
  const double mean = mean_with_one(std::sqrt(modulus.complement));
  const double mean_of_complement = mean_with_one(std::sqrt(m));
  constexpr double kPi = std::numbers::pi;
  modulus.quarter_period = 0.5 * kPi / mean;
  modulus.is_hyperbolic = m > 0.5;
  // pi K' / K; the ratio of the means is its inverse
  const double ratio =
      modulus.is_hyperbolic ? mean_of_complement / mean : mean / mean_of_complement;
  modulus.nome = portable_exp(-kPi * ratio);
  modulus.argument_scale = modulus.is_hyperbolic ? mean_of_complement : mean;
  const Thetas zero = circular_thetas(modulus.nome, 0.0);
  if (modulus.is_hyperbolic) {
    modulus.scale = {zero.three / zero.four, 2.0 * zero.two / zero.four,
                     2.0 * zero.two / zero.three};
  } else {
    modulus.scale = {zero.three / zero.two, zero.four / zero.two, zero.four / zero.three};
  }
  return modulus;
}

JacobiValues jacobi(const EllipticModulus& modulus, double u) {
  const double quarter = std::floor(u / modulus.quarter_period + 0.5);
  JacobiValues j = jacobi_near_zero(modulus, u - quarter * modulus.quarter_period);
  const double place = quarter - 4.0 * std::floor(0.25 * quarter);
  if (place == 1.0 || place == 3.0) {
    const double root = std::sqrt(modulus.complement);
    j = {j.cn / j.dn, -root * j.sn / j.dn, root / j.dn};
  }
  if (place >= 2.0) {
    j.sn = -j.sn;
    j.cn = -j.cn;
  }
  return j;
}

double carlson_rf(double x, double y, double z) {
  constexpr double kReach = 338.4;  // (3 epsilon)^(-1/6)
  const double mean0 = (x + y + z) / 3.0;
  const double spread = std::max({std::abs(mean0 - x), std::abs(mean0 - y), std::abs(mean0 - z)});
  const double reach = kReach * spread;
  double mean = mean0;
  double quarter = 1.0;
  const double x0 = mean0 - x;
  const double y0 = mean0 - y;
  while (quarter * reach >= mean) {
    const double lambda =
        std::sqrt(x) * std::sqrt(y) + std::sqrt(y) * std::sqrt(z) + std::sqrt(z) * std::sqrt(x);
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
    mean = 0.25 * (mean + lambda);
    quarter *= 0.25;
  }
  const double dx = x0 * quarter / mean;
  const double dy = y0 * quarter / mean;
  const double dz = -dx - dy;
  const double e2 = dx * dy - dz * dz;
  const double e3 = dx * dy * dz;
  return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / std::sqrt(mean);
}

double elliptic_f(const EllipticModulus& modulus, double sine, double cosine) {
  const double cosine2 = cosine * cosine;
  const double first = sine * carlson_rf(cosine2, modulus.complement + modulus.m * cosine2, 1.0);
  // by reflection beyond a quarter turn
  return cosine >= 0.0 ? first : std::copysign(2.0 * modulus.quarter_period, sine) - first;
}

}  // namespace glidar
