// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/rays/sweep_split.hpp>

#include <algorithm>
#include <bit>

namespace glidar::rays {
namespace {

/// Keys of references in the order of their middles along an axis: bits of the middle, then index.
using SweepOrder = std::array<std::uint64_t, kMaxSweep>;

/// Bits that are ordered as the numbers.
std::uint32_t ordered_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits ^ (bits >> 31U != 0 ? 0xFFFFFFFFU : 0x80000000U);
}

void sort_along(std::span<const BoxReference> references, std::size_t axis, SweepOrder& order) {
  for (std::uint32_t i = 0; i < references.size(); ++i) {
    const float middle = references[i].low[axis] + references[i].high[axis];
    order[i] = std::uint64_t{ordered_bits(middle)} << 32U | i;
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(references.size()));
}

struct SweepCut {
  float cost = kInfinityf;  ///< infinite: none, because areas overflow
  std::size_t axis = 0;
  std::uint32_t first_size = 0;
};

void find_cut_along(std::span<const BoxReference> references, const SweepOrder& order,
                    std::size_t axis, std::uint32_t block_size, SweepCut& best) {
  const auto count = static_cast<std::uint32_t>(references.size());
  const auto at = [&](std::uint32_t i) -> const BoxReference& {
    return references[static_cast<std::uint32_t>(order[i])];
  };
  const auto cost_of = [block_size](const SplitBox& box, std::uint32_t size) {
    const std::uint32_t blocks = (size + block_size - 1) / block_size;
    return box.area() * static_cast<float>(blocks);
  };
  std::array<float, kMaxSweep> second_cost;
  SplitBox box;
  for (std::uint32_t i = count - 1; i > 0; --i) {
    box.extend(low_of(at(i)), high_of(at(i)));
    second_cost[i] = cost_of(box, count - i);
  }
  box = {};
  for (std::uint32_t i = 1; i < count; ++i) {
    box.extend(low_of(at(i - 1)), high_of(at(i - 1)));
    const float cost = cost_of(box, i) + second_cost[i];
    if (cost < best.cost) best = {cost, axis, i};
  }
}

}  // namespace

std::uint32_t sweep_split(std::span<BoxReference> references, std::uint32_t block_size,
                          std::array<SplitExtent, 2>& sides) {
  std::array<SweepOrder, 3> orders;
  SweepCut best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sort_along(references, axis, orders[axis]);
    find_cut_along(references, orders[axis], axis, block_size, best);
  }
  const auto count = static_cast<std::uint32_t>(references.size());
  if (best.first_size == 0) best.first_size = count / 2;
  std::array<BoxReference, kMaxSweep> sorted;
  for (std::uint32_t i = 0; i < count; ++i) {
    sorted[i] = references[static_cast<std::uint32_t>(orders[best.axis][i])];
    sides[i < best.first_size ? 0 : 1].extend(sorted[i]);
  }
  std::copy_n(sorted.begin(), count, references.begin());
  return best.first_size;
}

}  // namespace glidar::rays
