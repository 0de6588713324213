// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/pinhole.hpp>

#include <Eigen/Core>

#include <optional>

namespace glidar {

/// Derivative of a place of the image by the point that is imaged there.
using ImageDerivative = Eigen::Matrix<double, 2, 3>;

/// How far from the axis a model is followed: a radius of the plane z = 1 (radial_tangential, fov),
/// an angle (fisheye), or a radius of the undistorted image (omni). Beyond it, the model has folded
/// over.
double distortion_limit(const Distortion& model);

/// The unit ray through a place of the image; NaN if there is none. Places count in focal lengths
/// from the principal point; of equirectangular images they are longitude and latitude.
Eigen::Vector3d undistorted_ray(const Distortion& model, const Eigen::Vector2d& place);

/// The inverse: where a point of the optical frame is imaged. Empty if it is not seen, also where
/// the model has folded over. `limit` is distortion_limit(model).
std::optional<Eigen::Vector2d> imaged(const Distortion& model, double limit,
                                      const Eigen::Vector3d& point);

/// Derivative of imaged(), where there is an image.
ImageDerivative imaged_derivative(const Distortion& model, const Eigen::Vector3d& point);

}  // namespace glidar
