// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/projection.hpp>

#include <cmath>

namespace glidar::opengl {

Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths) {
  // A beam goes through pixel (u, v) at u + pixel_centre; windows have centres at u + 0.5.
  const double centre_x = k.cx - k.pixel_centre + 0.5 - rect.first_col;
  const double centre_y = k.cy - k.pixel_centre + 0.5 - rect.first_row;
  const double to_depth = depths.near_m / (depths.far_m - depths.near_m);
  const Eigen::Matrix<double, 3, 4> sensor_matrix = sensor_from_object(view);
  Eigen::Matrix4d clip;
  clip.row(0) = 2.0 * k.fx / rect.cols * sensor_matrix.row(0) +
                (2.0 * centre_x / rect.cols - 1.0) * sensor_matrix.row(2);
  clip.row(1) = 2.0 * k.fy / rect.rows * sensor_matrix.row(1) +
                (2.0 * centre_y / rect.rows - 1.0) * sensor_matrix.row(2);
  clip.row(2) = -to_depth * sensor_matrix.row(2);
  clip(2, 3) += to_depth * depths.far_m;
  clip.row(3) = sensor_matrix.row(2);
  // Some graphics devices draw nothing at 1e-30 m. A common factor of all four coordinates has no
  // other effect, and a power of two rounds nothing.
  return (std::ldexp(1.0, -std::ilogb(depths.far_m)) * clip).cast<float>();
}

}  // namespace glidar::opengl
