// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/resolve.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace glidar::opengl {

/// A rectangle of a picture's pixels.
struct PixelRect {
  std::uint32_t first_row;
  std::uint32_t first_col;
  std::uint32_t rows;
  std::uint32_t cols;
};

/// The depths between which geometry lies, metres along the boresight; near > 0. Empty (far <=
/// near) when all of it lies behind the sensor.
struct DepthRange {
  double near_m;
  double far_m;

  [[nodiscard]] bool is_empty() const { return !(far_m > near_m); }
};

/// Depths of a box of an instance (mesh's frame, relative to its origin), from the sensor's plane.
/// The nearest may be negative.
void extend_depths(const InstanceView& view, const Eigen::AlignedBox3d& box, double& nearest_m,
                   double& farthest_m);

/// The planes that hug what lies between two depths: a hair outside of them, and in front of the
/// sensor.
DepthRange hugging(double nearest_m, double farthest_m);

/// From a mesh's vertices (relative to its origin) to clip coordinates of a pinhole's pixels: row 0
/// lies at the bottom of the window, and pixel centres lie where the beams go. Depth in the window
/// is near (far - z) / (z (far - near)): 1 at the near plane, 0 at the far plane. Floating point
/// has its digits near 0, so that single precision tells depths apart evenly. Worked out in double
/// relative to the sensor, so that a world far from its zero loses nothing.
Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths);

}  // namespace glidar::opengl
