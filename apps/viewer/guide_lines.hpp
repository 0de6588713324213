// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/io/pictures/picture.hpp>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace glidar::app {

/// A vertex of a line, or a point, relative to the anchor, in the layout of the vertex buffer.
struct ColouredVertex {
  Eigen::Vector3f position_m;
  Colour colour;
  std::uint8_t opacity = 255;
};
static_assert(sizeof(ColouredVertex) == 16, "the layout of the vertex buffer");

/// Lines, two vertices each.
using Lines = std::vector<ColouredVertex>;

/// 1, 2 or 5 times a power of ten metres, about a tenth of `extent_m`.
double grid_spacing_m(double extent_m);

/// A horizontal grid around a point, `extent_m` to every side; its lines are at multiples of the
/// spacing from the anchor.
void add_grid(const Eigen::Vector3d& about_m, double extent_m, double spacing_m, Lines& lines);

/// Axes of this pose: x red, y green, z blue.
void add_axes(const Pose& anchor_from_frame, double length_m, Lines& lines);

/// The edges of boxes, 8 corners each: corner i ^ 1, i ^ 2 and i ^ 4 are the neighbours of corner
/// i.
void add_boxes(std::span<const Eigen::Vector3d> corners_m, Lines& lines);

/// The edges of the beams' frustum up to a range: the border of the beams' grid, and lines to it
/// from their origins.
void add_frustum(const Beams& beams, const Pose& anchor_from_sensor, double range_m, Lines& lines);

}  // namespace glidar::app
