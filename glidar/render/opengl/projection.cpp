// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/projection.hpp>

#include <algorithm>

namespace glidar::opengl {
namespace {

/// Mesh to sensor, metres.
Eigen::Matrix<double, 3, 4> sensor_from_object(const InstanceView& view) {
  const Eigen::Matrix3d turn = view.scale * view.object_from_sensor.transpose();
  Eigen::Matrix<double, 3, 4> matrix;
  matrix << turn, -(turn * view.sensor_in_object);
  return matrix;
}

}  // namespace

void extend_depths(const InstanceView& view, const Eigen::AlignedBox3d& box, double& nearest_m,
                   double& farthest_m) {
  if (box.isEmpty()) return;
  const Eigen::Vector3d boresight = view.scale * view.object_from_sensor.col(2);
  const double middle = boresight.dot(box.center() - view.sensor_in_object);
  const double half = boresight.cwiseAbs().dot(0.5 * box.sizes());
  nearest_m = std::min(nearest_m, middle - half);
  farthest_m = std::max(farthest_m, middle + half);
}

DepthRange hugging(double nearest_m, double farthest_m) {
  // Single precision rounds a depth by 6e-8 of it, and places by as much of the farthest.
  constexpr double kRounding = 0x1p-22;
  constexpr double kNearestPart = 1e-7;  // of the farthest depth; what is nearer is rounding
  const double hair = kRounding * (farthest_m - std::max(nearest_m, 0.0)) +
                      0x1p-50 * (std::abs(farthest_m) + std::abs(nearest_m));
  const double far_m = farthest_m + hair;
  return {std::max(nearest_m - hair, kNearestPart * far_m), far_m};
}

Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths) {
  // A beam goes through pixel (u, v) at u + pixel_centre; windows have centres at u + 0.5.
  const double centre_x = k.cx - k.pixel_centre + 0.5 - rect.first_col;
  const double centre_y = k.cy - k.pixel_centre + 0.5 - rect.first_row;
  const double to_depth = depths.near_m / (depths.far_m - depths.near_m);
  const Eigen::Matrix<double, 3, 4> seen = sensor_from_object(view);
  Eigen::Matrix4d clip;
  clip.row(0) =
      2.0 * k.fx / rect.cols * seen.row(0) + (2.0 * centre_x / rect.cols - 1.0) * seen.row(2);
  clip.row(1) =
      2.0 * k.fy / rect.rows * seen.row(1) + (2.0 * centre_y / rect.rows - 1.0) * seen.row(2);
  clip.row(2) = -to_depth * seen.row(2);
  clip(2, 3) += to_depth * depths.far_m;
  clip.row(3) = seen.row(2);
  return clip.cast<float>();
}

}  // namespace glidar::opengl
