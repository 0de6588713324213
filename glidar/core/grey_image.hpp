// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace glidar {

/// Grey levels row by row from the top, without padding: width x height.
struct GreyImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t max_level = 255;  ///< greatest that the pixel type can store
  std::vector<std::uint16_t> level = {};
};

}  // namespace glidar
