// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

namespace glidar::depth {

/// An image between two filters: depths in units, or disparities in 1/32 px; 0: none.
struct FilterImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::variant<std::vector<std::uint16_t>, std::vector<float>> values;
  float focal_length_px = 0.0F;
};

}  // namespace glidar::depth
