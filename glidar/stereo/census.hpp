// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/stereo/kernel.hpp>
#include <glidar/stereo/stereo_match.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::stereo {

/// The census of an image in byte planes, each row plane after plane.
struct Census {
  std::size_t planes = 0;
  std::size_t plane_stride = 0;  ///< bytes between planes
  std::vector<std::uint8_t> bytes;

  [[nodiscard]] const std::uint8_t* row(std::size_t y) const {
    return bytes.data() + y * planes * plane_stride;
  }
};

/// Pixels beyond the edge of the image equal the nearest one of the image. A mirrored census has
/// column width - 1 - x in place of x, followed by `padding` unspecified columns.
Census make_census(const GreyImage& image, StereoCensus kind, bool is_mirrored, std::size_t padding,
                   const Kernel& kernel);

}  // namespace glidar::stereo
