// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/split_boxes.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace glidar::rays {

/// The maximum number of references that sweep_split() divides.
inline constexpr std::uint32_t kMaxSweep = 32;

/// Divides references, at least two, into two sides by the surface area heuristic: sorts them along
/// each axis and tries all positions. The cost of a side is its area times its number of blocks of
/// `block_size`, so that blocks are filled. Reorders the references; returns the size of the first
/// side.
std::uint32_t sweep_split(std::span<BoxReference> references, std::uint32_t block_size,
                          std::array<SplitExtent, 2>& sides);

}  // namespace glidar::rays
