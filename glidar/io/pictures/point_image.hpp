// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project.

#include <glidar/core/pose.hpp>

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace glidar {

/// Which point each pixel shows, row by row from the top.
struct PointImage {
  static constexpr std::uint32_t kNoPoint = 0xFFFFFFFFU;

  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint32_t> points;  ///< kNoPoint where none is
  std::vector<double> depths;         ///< infinite there; smaller is in front
  std::size_t outside = 0;            ///< points that the image does not show the place of
};

/// A view straight down on points in a frame with z up: x to the right, y up, equal scales.
struct TopView {
  double left_m = 0.0;
  double right_m = 1.0;
  double bottom_m = 0.0;
  double top_m = 1.0;
};

/// The view of this shape (width over height) that shows all points and `also_m`, but for the odd
/// point far away.
TopView fit_top_view(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& also_m,
                     double shape);

/// The highest point wins; each is a dot of so many pixels. Depth is minus the height.
PointImage draw_top_view(std::span<const Eigen::Vector3d> points_m, const TopView& view,
                         std::size_t width, std::size_t height);

/// A pinhole camera in a frame with z up.
struct Perspective {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d::UnitX();
  std::size_t width = 1;
  std::size_t height = 1;

  /// Column, row and depth of a point; no depth above 0: it is not before the camera.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& point_m) const;
};

/// The camera behind, above and to the right that sees most of the points.
Perspective fit_perspective(std::span<const Eigen::Vector3d> points_m, std::size_t width,
                            std::size_t height);

/// The nearest point wins; near points are larger.
PointImage draw_perspective(std::span<const Eigen::Vector3d> points_m, const Perspective& view);

/// How much of its colour each pixel keeps: less behind an edge in depth ("eye-dome lighting",
/// Boucheny, PhD thesis, Grenoble 2009), so that shapes stand out. Pixels without a point are 1.
std::vector<double> shade_edges(const PointImage& image);

}  // namespace glidar
