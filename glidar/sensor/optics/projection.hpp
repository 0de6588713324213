// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/optics/pinhole.hpp>

#include <Eigen/Core>
#include <optional>

namespace glidar {

/// Finds the pixels of points, the inverse of make_beams(pinhole).
class PinholeProjection {
 public:
  explicit PinholeProjection(const Pinhole& pinhole);

  /// Column and row of the image of a point in the optical frame, where whole numbers are centres
  /// of pixels, also outside the image. Empty when the camera does not see it: a point behind it,
  /// unless the model looks back, or where the distortion model has folded over.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& point) const;
  /// Derivative of pixel_of(), pixels per metre; NaN or infinite where there is no image.
  [[nodiscard]] Eigen::Matrix<double, 2, 3> pixel_derivative(const Eigen::Vector3d& point) const;
  /// The unit ray through a place of the image; NaN if there is none.
  [[nodiscard]] Eigen::Vector3d ray_through(const Eigen::Vector2d& pixel) const;

 private:
  Pinhole pinhole_;
  double limit_;  ///< distortion_limit()
};

}  // namespace glidar
