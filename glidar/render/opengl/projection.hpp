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
/// is at the bottom of the window, and beams pass through pixel centres. Window depth is reversed:
/// near (far - z) / (z (far - near)), 1 at the near plane and 0 at the far plane. Floats are
/// densest near 0, so single precision resolves depths evenly. Computed in double relative to the
/// sensor, so that scenes far from the world's origin lose no precision.
Eigen::Matrix4f clip_from_object(const InstanceView& view, const PinholeIntrinsics& k,
                                 const PixelRect& rect, const DepthRange& depths);

}  // namespace glidar::opengl
