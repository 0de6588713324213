// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace glidar {

/// The integral of a smooth function from 0 to x, for x in [0, end]: Chebyshev series over segments
/// of length at most 1, integrated term by term (Clenshaw and Curtis, Numer. Math. 2 (1960) 197).
/// Exact to rounding for a function without poles within 1.5 of the segments.
class IntegralTable {
 public:
  IntegralTable() = default;
  IntegralTable(double end, FunctionRef<double(double)> function);

  /// The integral from 0 to x, for x in [0, end].
  [[nodiscard]] double at(double x) const;

  /// The integral from 0 to the end.
  [[nodiscard]] double total() const { return total_; }

 private:
  static constexpr std::size_t kNodes = 20;  // (pi + sqrt(1 + pi^2))^-20 = 1e-16

  /// The integral up to the segment's start, and the coefficients of the integral from there.
  using Segment = std::array<double, kNodes + 1>;

  /// Appends a segment: the integral of a Chebyshev series.
  void add_segment(double length, const std::array<double, kNodes + 2>& series);

  double per_segment_ = 0.0;  ///< 1 / length
  double total_ = 0.0;
  std::vector<Segment> segments_;
};

// Jacobi's elliptic functions and integrals in double precision, from + - * / and square roots
// only, so that results are bit-identical on any machine. The parameter is m = k^2; its complement
// 1 - m is stored separately, so that m near 1 stays exact.

struct JacobiValues {
  double sn = 0.0;
  double cn = 1.0;
  double dn = 1.0;
};

/// Constants that depend on the parameter only.
struct EllipticModulus {
  double m = 0.0;
  double complement = 1.0;      ///< 1 - m, at least kMinComplement
  double quarter_period = 0.0;  ///< K(m)
  bool is_hyperbolic = false;   ///< m > 1/2: series in the nome of 1 - m
  double nome = 0.0;            ///< of m, or of 1 - m; at most exp(-pi)
  double argument_scale = 0.0;  ///< pi / (2 K(m)), or pi / (2 K(1 - m))
  JacobiValues scale = {};      ///< factors of quotients of theta functions
};

/// K = 343 there; for smaller complements the nome of 1 - m underflows.
inline constexpr double kMinComplement = 1e-296;

/// Periods by the arithmetic-geometric mean (DLMF 19.8.5), nome by DLMF 22.2.1.
EllipticModulus make_modulus(double m, double complement);

/// The functions at an argument, by the theta series of DLMF 20.2 and 22.2 within half a quarter
/// period of 0, for m > 1/2 after Jacobi's imaginary transformation (DLMF 22.6(iv)); elsewhere by
/// shifts of quarter periods (DLMF 22.4(iii)). cn and dn keep their relative precision where they
/// are small.
JacobiValues jacobi(const EllipticModulus& modulus, double u);

/// Carlson's symmetric integral for arguments >= 0, at most one of which is 0: DLMF 19.16.1, by
/// duplication (DLMF 19.36(i)).
double carlson_rf(double x, double y, double z);

/// F(angle | m) = integral of 1 / sqrt(1 - m sin^2) for the angle in [-pi, pi] with this sine and
/// cosine; both are arguments because either may be small (DLMF 19.25.5).
double elliptic_f(const EllipticModulus& modulus, double sine, double cosine);

}  // namespace glidar
