// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/stereo/stereo_match.hpp>

#include <vector>

namespace glidar {

class FieldVisitor;

/// A rectified pair of cameras.
struct StereoGeometry {
  double focal_length_px = 0.0;
  double baseline_m = 0.0;
  double column_offset_px = 0.0;  ///< principal column of the right minus that of the left image
  double depth_unit_m = 0.001;    ///< depths are multiples of this; 0: not rounded
};

/// Shows every value with its bounds and default to a visitor.
void describe(StereoGeometry& geometry, FieldVisitor& visitor);

/// Depth along the boresight of the left camera, z = f b / (disparity + offset), metres: one for
/// each pixel, NaN where there is no disparity or its sum with the offset is not above 0. Throws
/// Error when a value of the geometry is not allowed.
std::vector<float> stereo_depth_m(const StereoMatch& match, const StereoGeometry& geometry);

}  // namespace glidar
