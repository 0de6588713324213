// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/depth_range.hpp>
#include <glidar/render/resolver.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <Eigen/Core>

namespace glidar::opengl {

/// From a mesh's vertices (relative to its origin) to clip coordinates of a pinhole's pixels: row 0
/// lies at the bottom of the window, and pixel centres lie where the beams go. Depth in the window
/// is near (far - z) / (z (far - near)): 1 at the near plane, 0 at the far plane. Floating point
/// has its digits near 0, so that single precision tells depths apart evenly. Worked out in double
/// relative to the sensor, so that a world far from its zero loses nothing.
Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths);

}  // namespace glidar::opengl
