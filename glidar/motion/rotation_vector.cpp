// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/rotation_vector.hpp>

#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

struct Series {
  double value;
  double slope;  ///< derivative by x^2
};

/// The sum of (-q)^k / (2 k + n)!, n = 2 or 3, and its derivative by q: the series of
/// (1 - cos x) / x^2 and (x - sin x) / x^3 with q = x^2. Up to x = 10 the first omitted term is
/// below 1e-17.
Series alternating_series(double q, int n) {
  constexpr int kSeriesTerms = 24;
  double value = 0.0;
  double slope = 0.0;
  for (int k = kSeriesTerms; k > 0; --k) {  // Horner's scheme for both
    const double ratio = 1.0 / ((2.0 * k + n) * (2.0 * k + n - 1.0));
    slope = -ratio * (1.0 + value + q * slope);
    value = -q * ratio * (1.0 + value);
  }
  const double first = n == 2 ? 0.5 : 1.0 / 6.0;
  return {first * (1.0 + value), first * slope};
}

}  // namespace

Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  Eigen::Quaterniond turn = from.conjugate() * to;
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine == 0.0) return Vector3d::Zero();
  const double half_turns = atan2_turns(sine, turn.w());
  return (2.0 * kTwoPi * half_turns / sine) * turn.vec();
}

RotationArc::RotationArc(const Eigen::Quaterniond& before, const Eigen::Quaterniond& after) {
  const Eigen::Quaterniond turn = before.conjugate() * after;
  sign_ = turn.w() < 0.0 ? -1.0 : 1.0;
  turns_ = atan2_turns(turn.vec().norm(), std::abs(turn.w()));
  sine_ = sincos_turns(turns_).sine;
}

RotationVector::RotationVector(const Vector3d& vector) : r_(vector) {
  const double q = vector.squaredNorm();
  const Series a = alternating_series(q, 2);
  const Series b = alternating_series(q, 3);
  a_ = a.value;
  b_ = b.value;
  a_slope_ = a.slope;
  b_slope_ = b.slope;
}

Matrix3d RotationVector::matrix() const {
  const Matrix3d cross = cross_matrix(r_);
  const double sine = 1.0 - b_ * r_.squaredNorm();  // sin x / x
  return Matrix3d::Identity() + sine * cross + a_ * cross * cross;
}

Matrix3d RotationVector::right_jacobian() const {
  const Matrix3d cross = cross_matrix(r_);
  return Matrix3d::Identity() - a_ * cross + b_ * cross * cross;
}

Vector3d RotationVector::angular_velocity(const Vector3d& rate) const {
  const Vector3d once = r_.cross(rate);
  return rate - a_ * once + b_ * r_.cross(once);
}

/// The term of d/dt [r] times r' vanishes, because r' x r' = 0.
Vector3d RotationVector::jacobian_rate(const Vector3d& rate) const {
  const Vector3d once = r_.cross(rate);
  const double square_rate = 2.0 * r_.dot(rate);  // of x^2
  return square_rate * (b_slope_ * r_.cross(once) - a_slope_ * once) + b_ * rate.cross(once);
}

}  // namespace glidar
