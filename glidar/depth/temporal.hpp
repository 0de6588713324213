// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth/depth_filter.hpp>
#include <glidar/depth/filter_image.hpp>

#include <cstdint>
#include <vector>

namespace glidar::depth {

/// The frames before.
struct TemporalState {
  std::vector<float> last;  ///< the last value of each pixel; depths are whole; empty: no frame yet
  /// Which of the last 8 frames had a value that continued the one before, a bit for each frame of
  /// a cycle of 8.
  std::vector<std::uint8_t> history;
  unsigned frame = 0;  ///< of the cycle
};

void apply(const TemporalFilter& filter, FilterImage& image, TemporalState& state);

}  // namespace glidar::depth
