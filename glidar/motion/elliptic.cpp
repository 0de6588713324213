// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/elliptic.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// R_C(1, 1 + e) for e above -1 (DLMF 19.2.18 and 19.2.19).
double carlson_rc_one(double e) {
  constexpr double kSmall = 1e-3;  // there the first term left out is 1e-18 / 13
  if (std::abs(e) < kSmall) {
    return 1.0 - e * (1.0 / 3.0 - e * (1.0 / 5.0 - e * (1.0 / 7.0 - e * (1.0 / 9.0 - e / 11.0))));
  }
  const double root = std::sqrt(std::abs(e));
  return e > 0.0 ? std::atan(root) / root : std::atanh(root) / root;
}

double cubed(double x) {
  return x * x * x;
}

}  // namespace

EllipticModulus make_modulus(double m, double complement) {
  EllipticModulus modulus{.m = m, .complement = complement};
  double a = 1.0;
  double b = std::sqrt(complement);
  double c = std::sqrt(m);
  while (c > 0.25 * kEpsilon * a && modulus.steps + 1 < static_cast<int>(modulus.ratio.size())) {
    c = 0.5 * (a - b);
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
    modulus.ratio[static_cast<std::size_t>(++modulus.steps)] = c / a;
  }
  modulus.scale = std::ldexp(a, modulus.steps);
  modulus.quarter_period = 0.5 * std::numbers::pi / a;
  return modulus;
}

JacobiValues jacobi(const EllipticModulus& modulus, double u) {
  double angle = modulus.scale * u;
  for (int n = modulus.steps; n > 0; --n) {
    const double sine = modulus.ratio[static_cast<std::size_t>(n)] * std::sin(angle);
    angle = 0.5 * (angle + std::asin(std::clamp(sine, -1.0, 1.0)));
  }
  const double cn = std::cos(angle);
  // 1 - m sn^2 without cancellation
  return {std::sin(angle), cn, std::sqrt(modulus.complement + modulus.m * cn * cn)};
}

double carlson_rf(double x, double y, double z) {
  const double mean0 = (x + y + z) / 3.0;
  const double spread = std::max({std::abs(mean0 - x), std::abs(mean0 - y), std::abs(mean0 - z)});
  const double reach = std::pow(3.0 * kEpsilon, -1.0 / 6.0) * spread;
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

double carlson_rj(double x, double y, double z, double p) {
  const double mean0 = (x + y + z + 2.0 * p) / 5.0;
  const double delta = (p - x) * (p - y) * (p - z);
  const double spread = std::max(
      {std::abs(mean0 - x), std::abs(mean0 - y), std::abs(mean0 - z), std::abs(mean0 - p)});
  const double reach = std::pow(0.25 * kEpsilon, -1.0 / 6.0) * spread;
  const double x0 = mean0 - x;
  const double y0 = mean0 - y;
  const double z0 = mean0 - z;
  double mean = mean0;
  double quarter = 1.0;
  double sum = 0.0;
  while (quarter * reach >= mean) {
    const double rx = std::sqrt(x);
    const double ry = std::sqrt(y);
    const double rz = std::sqrt(z);
    const double rp = std::sqrt(p);
    const double lambda = rx * ry + ry * rz + rz * rx;
    const double d = (rp + rx) * (rp + ry) * (rp + rz);
    sum += quarter / d * carlson_rc_one(cubed(quarter) * delta / (d * d));
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
    p = 0.25 * (p + lambda);
    mean = 0.25 * (mean + lambda);
    quarter *= 0.25;
  }
  const double dx = x0 * quarter / mean;
  const double dy = y0 * quarter / mean;
  const double dz = z0 * quarter / mean;
  const double dp = -0.5 * (dx + dy + dz);
  const double e2 = dx * dy + dx * dz + dy * dz - 3.0 * dp * dp;
  const double e3 = dx * dy * dz + 2.0 * e2 * dp + 4.0 * cubed(dp);
  const double e4 = (2.0 * dx * dy * dz + e2 * dp + 3.0 * cubed(dp)) * dp;
  const double e5 = dx * dy * dz * dp * dp;
  const double series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 -
                        9.0 * e2 * e3 / 52.0 + 3.0 * e5 / 26.0;
  return quarter * series / (mean * std::sqrt(mean)) + 6.0 * sum;
}

double elliptic_f(const EllipticModulus& modulus, double sine, double cosine) {
  const double cosine2 = cosine * cosine;
  const double first = sine * carlson_rf(cosine2, modulus.complement + modulus.m * cosine2, 1.0);
  // beyond a quarter turn by reflection
  return cosine >= 0.0 ? first : std::copysign(2.0 * modulus.quarter_period, sine) - first;
}

double elliptic_pi(const EllipticModulus& modulus, double n, double u) {
  if (n == 0.0) return u;
  const auto part = [&](const JacobiValues& j) {
    const double sn2 = j.sn * j.sn;
    return n / 3.0 * j.sn * sn2 * carlson_rj(j.cn * j.cn, j.dn * j.dn, 1.0, 1.0 - n * sn2);
  };
  const double half_periods = std::round(0.5 * u / modulus.quarter_period);
  const double rest = u - 2.0 * half_periods * modulus.quarter_period;
  const double whole = part({1.0, 0.0, std::sqrt(modulus.complement)});
  return u + part(jacobi(modulus, rest)) + 2.0 * half_periods * whole;
}

}  // namespace glidar
