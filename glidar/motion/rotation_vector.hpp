// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private: rotation vectors (axis times angle, rad) and their rates, from + - * / and square roots
// only, so that results are bit-identical on any machine. The body's
// angular velocity w and acceleration follow from the rotation vector r(t) of R(t) = Exp(r(t)) by
// the right Jacobian: w = J(r) r', w' = J(r) r'' + (d/dt J(r)) r' (Sola, Deray, Atchuthan, "A micro
// Lie theory for state estimation in robotics" (2018), equation 143).

#include <glidar/math/elementary.hpp>

#include <Eigen/Geometry>

namespace glidar {

/// The rotation vector of the shorter arc from one orientation to the other, in the axes of the
/// first; its length is at most pi.
Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to);

/// The shorter arc between two unit quaternions (slerp: K. Shoemake, "Animating rotation with
/// quaternion curves", SIGGRAPH 1985). The rotation at a fraction of it, from 0 to 1, is the
/// normalised sum of both quaternions with these weights.
class RotationArc {
 public:
  struct Weights {
    double before;
    double after;
  };

  RotationArc(const Eigen::Quaterniond& before, const Eigen::Quaterniond& after);

  [[nodiscard]] Weights at(double fraction) const {
    if (sine_ == 0.0) return {1.0 - fraction, sign_ * fraction};
    return {sincos_turns((1.0 - fraction) * turns_).sine / sine_,
            sign_ * (sincos_turns(fraction * turns_).sine / sine_)};
  }

 private:
  double sign_ = 1.0;
  double turns_ = 0.0;  ///< of the angle between the quaternions, at most a quarter
  double sine_ = 0.0;   ///< of that angle
};

/// A rotation vector of up to 10 rad, and the coefficients of its functions.
class RotationVector {
 public:
  explicit RotationVector(const Eigen::Vector3d& vector);

  /// Exp(r), Rodrigues' formula.
  [[nodiscard]] Eigen::Matrix3d matrix() const;

  /// The right Jacobian J(r): body rate from the rate of the vector. Its inverse exists for lengths
  /// below 2 pi.
  [[nodiscard]] Eigen::Matrix3d right_jacobian() const;

  /// J(r) rate.
  [[nodiscard]] Eigen::Vector3d angular_velocity(const Eigen::Vector3d& rate) const;

  /// (d/dt J(r)) rate for the rate r' = rate.
  [[nodiscard]] Eigen::Vector3d jacobian_rate(const Eigen::Vector3d& rate) const;

 private:
  Eigen::Vector3d r_;
  double a_;        ///< (1 - cos x) / x^2 of the length x
  double b_;        ///< (x - sin x) / x^3
  double a_slope_;  ///< derivatives by x^2
  double b_slope_;
};

}  // namespace glidar
