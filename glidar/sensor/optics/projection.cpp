// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/projection.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/optics/lens_distortion.hpp>

#include <algorithm>
#include <numbers>

namespace glidar {
namespace {

/// The radial part of the model is followed up to 89 degrees from the axis, in steps of a 1/200 of
/// the radius; the polynomials of calibrations are smooth at this scale.
constexpr double kMaxTangent = 57.0;
constexpr double kRadiusGrowth = 1.005;
constexpr double kFirstRadius = 0.01;

/// The least radius at which the radial part folds over. Tangential terms shift it a little, which
/// fold_determinant() decides.
double fold_radius(RadialTangential k) {
  k.p1 = k.p2 = 0.0;
  for (double radius = kFirstRadius; radius < kMaxTangent; radius *= kRadiusGrowth) {
    if (fold_determinant(k, {radius, 0.0}) <= 0.0) return radius;
  }
  return kMaxTangent;
}

double max_radius(const NoDistortion& /*none*/) {
  return kInfinity;
}
double max_radius(const RadialTangential& k) {
  return std::min(k.max_radius, fold_radius(k));
}
double max_radius(const Fisheye& /*k*/) {
  return kInfinity;
}

using Place = std::optional<Eigen::Vector2d>;

Place imaged(const NoDistortion& /*none*/, const Eigen::Vector2d& plane) {
  return plane;
}

Place imaged(const RadialTangential& k, const Eigen::Vector2d& plane) {
  if (!(fold_determinant(k, plane) > 0.0)) return {};
  return distorted(k, plane);
}

/// theta_d (x, y) / r; see Fisheye. Only points in front of the camera, like the others.
Place imaged(const Fisheye& k, const Eigen::Vector2d& plane) {
  const double radius = plane.norm();
  if (radius == 0.0) return plane;
  const double theta = 2.0 * std::numbers::pi * atan2_turns(radius, 1.0);
  const double t2 = theta * theta;
  const double slope =
      1.0 + t2 * (3.0 * k.k1 + t2 * (5.0 * k.k2 + t2 * (7.0 * k.k3 + t2 * 9.0 * k.k4)));
  if (!(slope > 0.0)) return {};
  const double value = theta * (1.0 + t2 * (k.k1 + t2 * (k.k2 + t2 * (k.k3 + t2 * k.k4))));
  return plane * (value / radius);
}

}  // namespace

PinholeProjection::PinholeProjection(const Pinhole& pinhole) : pinhole_(pinhole) {
  const double radius =
      std::visit([](const auto& model) { return max_radius(model); }, pinhole.distortion);
  max_radius2_ = radius * radius;
}

Place PinholeProjection::pixel_of(const Eigen::Vector3d& point) const {
  if (!(point.z() > 0.0)) return {};
  const Eigen::Vector2d plane = point.head<2>() / point.z();
  if (!(plane.squaredNorm() <= max_radius2_)) return {};
  const Place place =
      std::visit([&](const auto& model) { return imaged(model, plane); }, pinhole_.distortion);
  if (!place) return {};
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  return Eigen::Vector2d(k.fx * place->x() + k.cx - k.pixel_centre,
                         k.fy * place->y() + k.cy - k.pixel_centre);
}

Eigen::Vector3d PinholeProjection::ray_through(const Eigen::Vector2d& pixel) const {
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  const Eigen::Vector2d plane((pixel.x() + k.pixel_centre - k.cx) / k.fx,
                              (pixel.y() + k.pixel_centre - k.cy) / k.fy);
  return std::visit([&](const auto& model) { return undistorted_ray(model, plane); },
                    pinhole_.distortion);
}

}  // namespace glidar
