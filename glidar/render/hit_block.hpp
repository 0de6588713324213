// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/lanes.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// The mask of all lanes.
inline constexpr std::uint32_t kAllLanes = (1U << kLanes) - 1U;

/// True when all lanes, also those outside of the mask, have the same instance.
inline bool is_one_instance(const HitBlock& block) {
  std::uint32_t differing = 0;
  for (unsigned i = 1; i < kLanes; ++i) differing |= block.instance[i] ^ block.instance[0];
  return differing == 0;
}

/// Writes value_of(lane) to the beams of these lanes; `column` has one entry per beam.
template <class T, class ValueOf>
void write_lanes(const HitBlock& block, std::uint32_t lanes, const ValueOf& value_of,
                 std::vector<T>& column) {
  if (block.is_run && lanes == kAllLanes) {  // a loop that vectorises
    T* const first = column.data() + block.beam[0];
    for (unsigned i = 0; i < kLanes; ++i) first[i] = value_of(i);
    return;
  }
  for_lanes(lanes, [&](unsigned i) { column[block.beam[i]] = value_of(i); });
}

}  // namespace glidar
