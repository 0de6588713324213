// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/pinhole.hpp>

#include <Eigen/Core>

namespace glidar {

/// The unit ray through a distorted point of the plane z = 1; NaN if there is none.
Eigen::Vector3d undistorted_ray(const NoDistortion& none, const Eigen::Vector2d& plane);
Eigen::Vector3d undistorted_ray(const RadialTangential& k, const Eigen::Vector2d& plane);
Eigen::Vector3d undistorted_ray(const Fisheye& k, const Eigen::Vector2d& plane);

/// OpenCV's forward model: where a point of the plane z = 1 is imaged on it.
Eigen::Vector2d distorted(const RadialTangential& k, const Eigen::Vector2d& plane);

/// The determinant of the derivative of distorted(): where it is not positive, the model has folded
/// over and is not valid.
double fold_determinant(const RadialTangential& k, const Eigen::Vector2d& plane);

}  // namespace glidar
