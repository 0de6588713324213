// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project: images of point clouds.

#include <glidar/core/pose.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// The visible point of each pixel, row by row from the top.
struct PointImage {
  static constexpr std::uint32_t kNoPoint = 0xFFFFFFFFU;

  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint32_t> points;  ///< kNoPoint for none
  std::vector<double> depths;         ///< infinite for no point; smaller is in front
  std::size_t outside = 0;            ///< number of points outside the image
};

/// A view from above on points in a frame with z up: x to the right, y up, equal scales.
struct TopView {
  double left_m = 0.0;
  double right_m = 1.0;
  double bottom_m = 0.0;
  double top_m = 1.0;
};

/// The view with this aspect ratio (width over height) that shows all points and `also_m`, except
/// distant outliers.
TopView fit_top_view(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& also_m,
                     double shape);

/// Draws points as dots; the highest point is visible. Depth is minus the height.
PointImage draw_top_view(std::span<const Eigen::Vector3d> points_m, const TopView& view,
                         std::size_t width, std::size_t height);

/// A pinhole camera in a frame with z up.
struct Perspective {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d::UnitX();
  std::size_t width = 1;
  std::size_t height = 1;

  /// Column, row and depth of a point; depth <= 0: behind the camera.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& point_m) const;
};

/// A camera behind, above and to the right of the sensor that sees most of the points.
Perspective fit_perspective(std::span<const Eigen::Vector3d> points_m, std::size_t width,
                            std::size_t height);

/// Draws points as dots, near ones larger; the nearest point is visible.
PointImage draw_perspective(std::span<const Eigen::Vector3d> points_m, const Perspective& view);

/// The brightness factor of each pixel: smaller behind a depth edge ("eye-dome lighting",
/// Boucheny, PhD thesis, Grenoble 2009), which emphasises shapes. Pixels without a point have 1.
std::vector<double> shade_edges(const PointImage& image);

}  // namespace glidar
