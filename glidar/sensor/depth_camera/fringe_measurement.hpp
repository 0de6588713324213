// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/depth_camera/structured_light.hpp>
#include <glidar/structured_light/fringe_trace.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Decoded images and their depths.
struct MeasuredFringes {
  DecodedFringes decoded;
  std::vector<float> depth_m;  ///< NaN unless the status is valid
};

/// decode_fringes() and triangulate(). A pixel whose coordinate leads to no depth becomes
/// inconsistent, without a coordinate. Throws Error as they do. `pool` may be null.
MeasuredFringes measure_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                                ThreadPool* pool = nullptr);

/// explain_fringes() of a pixel as measure_fringes() decodes it: a coordinate that leads to no
/// depth is a further test, which fails.
FringeTrace explain_fringes(std::span<const GreyImage> images, const StructuredLight& setup,
                            std::array<std::uint32_t, 2> column_row);

}  // namespace glidar
