// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/lens_distortion.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr int kMaxNewtonSteps = 50;
constexpr double kConverged =
    1e-14;  // residual on the normalised plane: below any pixel's rounding

/// Derivative of `distorted`, by the chain rule.
Eigen::Matrix2d distortion_jacobian(const RadialTangential& k, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double above = 1.0 + r2 * (k.k1 + r2 * (k.k2 + r2 * k.k3));
  const double below = 1.0 + r2 * (k.k4 + r2 * (k.k5 + r2 * k.k6));
  const double above_slope = k.k1 + r2 * (2.0 * k.k2 + 3.0 * r2 * k.k3);
  const double below_slope = k.k4 + r2 * (2.0 * k.k5 + 3.0 * r2 * k.k6);
  const double radial = above / below;
  const double slope =
      (above_slope * below - above * below_slope) / (below * below);  // d radial/d r2
  const double x = p.x();
  const double y = p.y();
  Eigen::Matrix2d j;
  j(0, 0) = radial + 2.0 * x * x * slope + 2.0 * k.p1 * y + 6.0 * k.p2 * x;
  j(0, 1) = 2.0 * x * y * slope + 2.0 * k.p1 * x + 2.0 * k.p2 * y;
  j(1, 0) = 2.0 * x * y * slope + 2.0 * k.p1 * x + 2.0 * k.p2 * y;
  j(1, 1) = radial + 2.0 * y * y * slope + 6.0 * k.p1 * y + 2.0 * k.p2 * x;
  return j;
}

}  // namespace

Eigen::Vector2d distorted(const RadialTangential& k, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double radial =
      (1.0 + r2 * (k.k1 + r2 * (k.k2 + r2 * k.k3))) / (1.0 + r2 * (k.k4 + r2 * (k.k5 + r2 * k.k6)));
  const double xy = p.x() * p.y();
  return {p.x() * radial + 2.0 * k.p1 * xy + k.p2 * (r2 + 2.0 * p.x() * p.x()),
          p.y() * radial + k.p1 * (r2 + 2.0 * p.y() * p.y()) + 2.0 * k.p2 * xy};
}

Eigen::Vector3d undistorted_ray(const NoDistortion& /*none*/, const Eigen::Vector2d& plane) {
  return direction_through(plane.x(), plane.y());
}

/// Newton's method from the distorted point. The solution must be on the branch of the image
/// centre, where the Jacobian is positive: beyond it the model folds over and is invalid. Nothing
/// is imaged beyond max_radius either.
Eigen::Vector3d undistorted_ray(const RadialTangential& k, const Eigen::Vector2d& plane) {
  Eigen::Vector2d p = plane;
  const double tolerance = kConverged * (1.0 + plane.norm());
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Eigen::Vector2d residual = distorted(k, p) - plane;
    const Eigen::Matrix2d jacobian = distortion_jacobian(k, p);
    if (!(jacobian.determinant() > 0.0)) break;
    if (residual.norm() <= tolerance) {
      if (p.norm() > k.max_radius) break;
      return direction_through(p.x(), p.y());
    }
    p -= jacobian.inverse() * residual;
  }
  return {kNaN, kNaN, kNaN};
}

/// Newton's method on theta_d(theta) = r; see Fisheye.
Eigen::Vector3d undistorted_ray(const Fisheye& k, const Eigen::Vector2d& plane) {
  const double radius = plane.norm();
  if (radius == 0.0) return Eigen::Vector3d::UnitZ();
  double theta = std::min(radius, std::numbers::pi);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const double t2 = theta * theta;
    const double value = theta * (1.0 + t2 * (k.k1 + t2 * (k.k2 + t2 * (k.k3 + t2 * k.k4))));
    const double slope =
        1.0 + t2 * (3.0 * k.k1 + t2 * (5.0 * k.k2 + t2 * (7.0 * k.k3 + t2 * 9.0 * k.k4)));
    if (!(slope > 0.0) || !(theta >= 0.0) || theta > std::numbers::pi) break;
    if (std::abs(value - radius) <= kConverged * (1.0 + radius)) {
      const Eigen::Vector2d side = plane / radius * portable_sin(theta);
      return Eigen::Vector3d(side.x(), side.y(), portable_cos(theta)).normalized();
    }
    theta -= (value - radius) / slope;
  }
  return {kNaN, kNaN, kNaN};
}

double fold_determinant(const RadialTangential& k, const Eigen::Vector2d& plane) {
  return distortion_jacobian(k, plane).determinant();
}

}  // namespace glidar
