// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/core/pose.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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

class FieldVisitor;

/// The state at t0 of a rigid body without torque.
struct InitialRotation {
  Eigen::Vector3d moments_kg_m2 =
      Eigen::Vector3d::Ones();  ///< principal moments of inertia; only ratios matter
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< about the principal axes
  Pose world_from_body = Pose::Identity();
  Pose body_from_principal = Pose::Identity();  ///< centre of mass and principal axes in the body
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of the centre of mass, in the world
  std::int64_t t0_ns = 0;
};

/// Throws Error with the invalid field if a number is not finite, a moment of inertia is not
/// positive or is more than 1e9 times another, one exceeds the sum of the other two (impossible
/// for a body), or a pose is not rigid.
void validate(const InitialRotation& start);

/// Keys of `tumbling`; files have the pose of the body beside it, at time 0.
void describe(InitialRotation& start, FieldVisitor& visitor);

/// The free motion of a rigid body in closed form, by Jacobi's elliptic functions: Landau and
/// Lifshitz, "Mechanics" (3rd ed.), section 37, with an attitude that is regular near every axis.
/// Every time has the same cost; nothing is integrated stepwise. The attitude is exact to 1e-13 rad
/// and 1e-15 of the rotation angle, angular momentum and energy to a relative 1e-13, for all axes
/// and rates; results are bit-identical on any machine. Off-axis rates below 1e-140 of the total
/// are ignored. A start exactly on the separatrix, which theoretically never flips, flips after
/// about 343 of the elliptic functions' units of time.
class TorqueFreeRotation {
 public:
  /// Throws Error as validate() does.
  explicit TorqueFreeRotation(const InitialRotation& start);

  [[nodiscard]] Pose pose_at(std::int64_t t_ns) const;

  /// The angular velocity in the principal axes, rad/s.
  [[nodiscard]] Eigen::Vector3d rate_at(std::int64_t t_ns) const;

  /// The angular acceleration in the principal axes, rad/s^2: Euler's equations without torque
  /// (Landau and Lifshitz, equation 36.5).
  [[nodiscard]] Eigen::Vector3d angular_acceleration_at(std::int64_t t_ns) const;

  [[nodiscard]] const InitialRotation& start() const { return start_; }

 private:
  struct Solution;

  InitialRotation start_;
  std::shared_ptr<const Solution> solution_;  ///< nullptr: the rate is constant
};

}  // namespace glidar
