// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/lanes.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace glidar {

/// Up to kLanes hits: beam, instance and triangle. Only lanes of the mask count.
struct HitBlock {
  std::uint32_t mask = 0;  ///< bit i: lane i is in use: a beam to cast, then a hit
  std::array<std::size_t, kLanes> beam;
  std::array<std::uint32_t, kLanes> instance;
  std::array<std::uint32_t, kLanes> primitive;
  bool is_one_triangle = false;  ///< surely all lanes of the mask hit the same one
  bool is_run = false;           ///< surely all lanes hit, and their beams follow each other
};

}  // namespace glidar
