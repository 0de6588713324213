// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/stereo/stereo_match.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::stereo {

/// Sums over the window of each pixel, of 2 radius + 1 rows and columns, as far as it is inside the
/// image.
struct WindowSums {
  std::vector<std::uint32_t> step;       ///< |level(x + 1) - level(x)|
  std::vector<std::uint16_t> saturated;  ///< pixels of at least the saturation level
  std::vector<std::uint16_t> pixels;     ///< pixels in the window
};

/// `pool` may be null.
WindowSums sum_windows(const GreyImage& image, std::uint32_t radius, std::uint32_t saturation_level,
                       ThreadPool* pool);

}  // namespace glidar::stereo
