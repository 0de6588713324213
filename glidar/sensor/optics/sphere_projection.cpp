// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/sphere_projection.hpp>

#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {
namespace {

Eigen::Vector3d stretched(const Spheres& s, const Eigen::Vector3d& point) {
  const double root = std::sqrt(s.beta);
  return {root * point.x(), root * point.y(), point.z()};
}

}  // namespace

std::optional<Eigen::Vector2d> sphere_place(const Spheres& s, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = stretched(s, point);
  const double w = s.xi * q.norm() + q.z();
  const double d2 = std::sqrt(q.x() * q.x() + q.y() * q.y() + w * w);
  const double below = s.alpha * d2 + (1.0 - s.alpha) * w;
  // beyond this angle the image folds over (alpha > 1/2) or the denominator is not positive
  const double side = s.alpha <= 0.5 ? s.alpha / (1.0 - s.alpha) : (1.0 - s.alpha) / s.alpha;
  if (!(w > -side * d2) || !(below > 0.0)) return {};
  return Eigen::Vector2d(point.head<2>() * (s.scale / below));
}

Eigen::Matrix<double, 2, 3> sphere_derivative(const Spheres& s, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = stretched(s, point);
  const double d1 = q.norm();
  const double w = s.xi * d1 + q.z();
  const double d2 = std::sqrt(q.x() * q.x() + q.y() * q.y() + w * w);
  const double below = s.alpha * d2 + (1.0 - s.alpha) * w;
  const Eigen::Vector3d slope_w = s.xi / d1 * q + Eigen::Vector3d::UnitZ();  // by q
  const Eigen::Vector3d level(q.x(), q.y(), 0.0);
  const Eigen::Vector3d slope = s.alpha / d2 * (level + w * slope_w) + (1.0 - s.alpha) * slope_w;
  const Eigen::Vector3d by_point = stretched(s, slope);
  Eigen::Matrix<double, 2, 3> j = -point.head<2>() * by_point.transpose() / (below * below);
  j(0, 0) += 1.0 / below;
  j(1, 1) += 1.0 / below;
  return s.scale * j;
}

Eigen::Vector3d sphere_ray(const Spheres& s, const Eigen::Vector2d& place) {
  const double root = std::sqrt(s.beta);
  const Eigen::Vector2d m = root / s.scale * place;
  const double r2 = m.squaredNorm();
  const double inner = 1.0 - (2.0 * s.alpha - 1.0) * r2;
  if (!(inner >= 0.0)) return Eigen::Vector3d::Constant(kNaN);
  const double mz = (1.0 - s.alpha * s.alpha * r2) / (s.alpha * std::sqrt(inner) + 1.0 - s.alpha);
  const double onto = mz * mz + (1.0 - s.xi * s.xi) * r2;
  if (!(onto >= 0.0)) return Eigen::Vector3d::Constant(kNaN);
  const double k = (mz * s.xi + std::sqrt(onto)) / (mz * mz + r2);
  const Eigen::Vector3d q(k * m.x(), k * m.y(), k * mz - s.xi);
  return Eigen::Vector3d(q.x() / root, q.y() / root, q.z()).normalized();
}

}  // namespace glidar
