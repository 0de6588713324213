// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace glidar {

/// Depths along the boresight row by row from the top, as drivers of depth cameras report them: 16
/// bits, multiples of a unit, 0 for none. width x height.
struct DepthImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint16_t> depth = {};
};

}  // namespace glidar
