// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>

namespace glidar {

/// A height map converted to normals.
struct HeightNormals {
  Texture texture;  ///< rgb, n = 2 rgb - 1
  float normal_scale =
      1.0F;  ///< for Material::normal_scale: the map is stretched to use its 8 bits
};

/// Slopes by central differences (Blinn, Simulation of wrinkled surfaces, 1978): a height of 1.0
/// (white) equals the width of one texel, so n ~ (-dh/dx, -dh/dy, 1) with x right and y up in
/// texels. The image repeats at its borders. Grey, or the first channel of colours. With a bump
/// multiplier, multiply normal_scale by it.
HeightNormals normals_from_heights(const Texture& heights);

/// True when the image is likely a tangent-space normal map: three channels, not grey, and mostly
/// blue (normals that point out of the surface). Otherwise it is treated as heights.
bool looks_like_normal_map(const Texture& image);

}  // namespace glidar
