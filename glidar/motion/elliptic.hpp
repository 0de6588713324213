// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/motion: Jacobi's elliptic functions and integrals, in double precision.
// The parameter is m = k^2; its complement 1 - m is given apart, so that m near 1 stays exact.

#include <array>

namespace glidar {

/// All that depends on the parameter alone.
struct EllipticModulus {
  double m = 0.0;
  double complement = 1.0;      ///< 1 - m, above 0
  double quarter_period = 0.0;  ///< K(m)
  double scale = 1.0;           ///< 2^steps a_steps of the mean
  int steps = 0;
  std::array<double, 16> ratio{};  ///< c_n / a_n, n from 1 to steps
};

/// By the arithmetic-geometric mean: Abramowitz & Stegun, "Handbook of Mathematical Functions",
/// 16.4 and 17.6.
EllipticModulus make_modulus(double m, double complement);

struct JacobiValues {
  double sn = 0.0;
  double cn = 1.0;
  double dn = 1.0;
};

/// Abramowitz & Stegun 16.4.
JacobiValues jacobi(const EllipticModulus& modulus, double u);

/// Carlson's symmetric integrals, for arguments from 0 of which at most one is 0, and p above 0:
/// DLMF 19.16.1 and 19.16.2, by duplication (DLMF 19.36(i)).
double carlson_rf(double x, double y, double z);
double carlson_rj(double x, double y, double z, double p);

/// F(angle | m) = integral of 1 / sqrt(1 - m sin^2) for the angle in [-pi, pi] with this sine and
/// cosine, each given because either may be small (DLMF 19.25.5).
double elliptic_f(const EllipticModulus& modulus, double sine, double cosine);

/// Integral of 1 / (1 - n sn^2) from 0 to u, for n up to 0 and any u: Pi(n; am u | m)
/// (DLMF 19.25.14).
double elliptic_pi(const EllipticModulus& modulus, double n, double u);

}  // namespace glidar
