// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/stereo_depth.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>

#include <cmath>

namespace glidar {

namespace {

void validate_geometry(const StereoGeometry& geometry) {
  require_number(accepts(kAboveZero, geometry.focal_length_px), "stereo geometry, focal_length_px",
                 geometry.focal_length_px, kAboveZero.allowed);
  require_number(accepts(kAboveZero, geometry.baseline_m), "stereo geometry, baseline_m",
                 geometry.baseline_m, kAboveZero.allowed);
  require_number(accepts(kFinite, geometry.column_offset_px), "stereo geometry, column_offset_px",
                 geometry.column_offset_px, kFinite.allowed);
  require_number(accepts(kFromZero, geometry.depth_unit_m), "stereo geometry, depth_unit_m",
                 geometry.depth_unit_m, kFromZero.allowed);
}

}  // namespace

void describe(StereoGeometry& geometry, FieldVisitor& visitor) {
  visitor.number({"focal_length_px", "of both rectified cameras", kUnitPixel, kRequired},
                 kAboveZero, geometry.focal_length_px);
  visitor.number({"baseline_m", "distance of the cameras", kUnitMetre, kRequired}, kAboveZero,
                 geometry.baseline_m);
  visitor.number({"column_offset_px", "principal column of the right minus that of the left image",
                  kUnitPixel},
                 kFinite, geometry.column_offset_px);
  visitor.number({"depth_unit_m", "depths are multiples of this; 0: not rounded", kUnitMetre},
                 kFromZero, geometry.depth_unit_m);
}

std::vector<float> stereo_depth_m(const StereoMatch& match, const StereoGeometry& geometry) {
  validate_geometry(geometry);
  const double product = geometry.focal_length_px * geometry.baseline_m;
  std::vector<float> depth_m(match.disparity_px.size(), kNaNf);
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double disparity = match.disparity_px[i] + geometry.column_offset_px;
    if (!(disparity > 0.0)) continue;  // holes are NaN
    double z = product / disparity;
    if (geometry.depth_unit_m > 0.0) {
      z = std::floor(z / geometry.depth_unit_m + 0.5) * geometry.depth_unit_m;
    }
    depth_m[i] = static_cast<float>(z);
  }
  return depth_m;
}

}  // namespace glidar
