// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/projection.hpp>

#include <glidar/sensor/optics/lens_distortion.hpp>

namespace glidar {

PinholeProjection::PinholeProjection(const Pinhole& pinhole)
    : pinhole_(pinhole), limit_(distortion_limit(pinhole.distortion)) {}

std::optional<Eigen::Vector2d> PinholeProjection::pixel_of(const Eigen::Vector3d& point) const {
  const auto place = imaged(pinhole_.distortion, limit_, point);
  if (!place) return {};
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  return Eigen::Vector2d(k.fx * place->x() + pinhole_.skew_px * place->y() + k.cx - k.pixel_centre,
                         k.fy * place->y() + k.cy - k.pixel_centre);
}

Eigen::Matrix<double, 2, 3> PinholeProjection::pixel_derivative(
    const Eigen::Vector3d& point) const {
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  Eigen::Matrix2d pixels;
  pixels << k.fx, pinhole_.skew_px, 0.0, k.fy;
  return pixels * imaged_derivative(pinhole_.distortion, point);
}

Eigen::Vector3d PinholeProjection::ray_through(const Eigen::Vector2d& pixel) const {
  const PinholeIntrinsics& k = pinhole_.intrinsics;
  const double y = (pixel.y() + k.pixel_centre - k.cy) / k.fy;
  const double x = (pixel.x() + k.pixel_centre - k.cx - pinhole_.skew_px * y) / k.fx;
  return undistorted_ray(pinhole_.distortion, {x, y});
}

}  // namespace glidar
