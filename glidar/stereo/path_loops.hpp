// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Inner loops of the path costs,
// L(p, d) = C(p, d) + min(L(q, d), L(q, d-1) + P1, L(q, d+1) + P1, m + P2) - m, m = min L(q),
// q the pixel before p on the path (Hirschmueller 2008, eq. 13). Included by kernel.cpp only.
#include <glidar/stereo/kernel.hpp>
#include <glidar/stereo/simd.hpp>

namespace glidar::stereo::GLIDAR_KERNEL {
namespace {

struct Penalties {
  Words p1;
  Words p2;
};

/// L from C and L of the pixel before: at lane d, d - 1 and d + 1, and its least.
GLIDAR_INLINE Words path_cost(Words cost, Words same, Words below, Words above, Words before_least,
                              const Penalties& penalties) {
  const Words step = min(below, above) + penalties.p1;
  return cost + min(min(same, step) - before_least, penalties.p2);
}

/// kNoCost in the lanes of the last block that are beyond the search, 0 in the others.
struct Beyond {
  std::int16_t lane[kLaneBlock];
  Beyond(std::size_t disparities, std::size_t lanes) {
    const std::size_t begin = lanes - kLaneBlock;
    for (std::size_t i = 0; i < kLaneBlock; ++i) lane[i] = begin + i < disparities ? 0 : kNoCost;
  }
};

/// One pixel of a sweep; `before` and `after` are states of the pixel before and of this one.
/// Returns the least of its path costs.
template <bool kIsFirst>
GLIDAR_INLINE int sweep_pixel(const SweepRow& row, const Beyond& beyond, std::size_t x,
                              const std::int16_t* before, std::int16_t* after, int before_least) {
  const Penalties penalties = {broadcast(row.p1), broadcast(row.p2)};
  const std::int16_t* const cost = row.cost + x * row.lanes;
  std::int16_t* const sum = row.sum + x * row.lanes;
  const Words floor = broadcast(before_least);
  Words lowest = broadcast(kNoCost);
  const auto step = [&](std::size_t d) {
    return path_cost(load(cost + d), load(before + d), load(before + d - 1), load(before + d + 1),
                     floor, penalties);
  };
  const auto finish = [&](std::size_t d, Words path) {
    store(after + d, path);
    lowest = min(lowest, path);
    store(sum + d, kIsFirst ? path ^ broadcast(-kSumOffset) : wrapped_sum(load(sum + d), path));
  };
  const std::size_t last = row.lanes - kLaneBlock;
  for (std::size_t d = 0; d < last; d += kWords) finish(d, step(d));
  for (std::size_t i = 0; i < kLaneBlock; i += kWords) {
    finish(last + i, max(step(last + i), load(beyond.lane + i)));
  }
  return least(lowest);
}

template <bool kIsFirst>
void sweep_all(const SweepRow& row) {
  const Beyond beyond(row.disparities, row.lanes);
  const std::size_t stride = row.lanes + kStateGap;
  std::int16_t* before = row.state + kStateGap;
  std::int16_t* after = before + stride;
  for (std::size_t i = 0; i < 2 * stride + kStateGap; ++i) row.state[i] = kNoCost;
  for (std::size_t d = 0; d < row.lanes; ++d) before[d] = 0;
  int lowest = 0;
  for (std::size_t i = 0; i < row.width; ++i) {
    const std::size_t x = row.is_backwards ? row.width - 1 - i : i;
    lowest = sweep_pixel<kIsFirst>(row, beyond, x, before, after, lowest);
    std::int16_t* const swapped = before;
    before = after;
    after = swapped;
  }
}

void sweep_row(const SweepRow& row) {
  if (row.is_first) return sweep_all<true>(row);
  sweep_all<false>(row);
}

/// One path at one pixel, from lane to lane. The state is replaced in place: lane d - 1 of the
/// pixel before is read before its successor is written.
struct PathStep {
  std::int16_t* state;
  Words floor;
  Words lowest;
  Words below;

  GLIDAR_INLINE void start(std::int16_t* at, int before_least) {
    state = at;
    floor = broadcast(before_least);
    lowest = broadcast(kNoCost);
    below = load(at - 1);
  }
  GLIDAR_INLINE Words next(std::size_t d, Words cost, Words beyond, const Penalties& penalties) {
    const Words path =
        max(path_cost(cost, load(state + d), below, load(state + d + 1), floor, penalties), beyond);
    below = load(state + d + kWords - 1);
    store(state + d, path);
    lowest = min(lowest, path);
    return path;
  }
};

template <std::size_t kPaths>
GLIDAR_INLINE void down_pixel(const DownRow& row, const Beyond& beyond, std::size_t x) {
  const Penalties penalties = {broadcast(row.p1), broadcast(row.p2)};
  const std::size_t offset = x * row.lanes;
  PathStep steps[kPaths];
  for (std::size_t k = 0; k < kPaths; ++k) {
    steps[k].start(row.state[k] + x * (row.lanes + kStateGap), row.least[k][x]);
  }
  const auto advance = [&](std::size_t d, Words past) {
    const Words cost = load(row.cost + offset + d);
    Words sum = load(row.sum + offset + d);
    for (std::size_t k = 0; k < kPaths; ++k) {
      sum = wrapped_sum(sum, steps[k].next(d, cost, past, penalties));
    }
    store(row.new_sum + offset + d, sum);
  };
  const std::size_t last = row.lanes - kLaneBlock;
  for (std::size_t d = 0; d < last; d += kWords) advance(d, Words{});
  for (std::size_t i = 0; i < kLaneBlock; i += kWords) advance(last + i, load(beyond.lane + i));
  for (std::size_t k = 0; k < kPaths; ++k) {
    row.least[k][x] = static_cast<std::int16_t>(least(steps[k].lowest));
  }
}

template <std::size_t kPaths>
void down_all(const DownRow& row) {
  const Beyond beyond(row.disparities, row.lanes);
  for (std::size_t x = 0; x < row.count; ++x) down_pixel<kPaths>(row, beyond, x);
}

void down_row(const DownRow& row) {
  if (row.paths == 1) return down_all<1>(row);
  down_all<3>(row);
}

}  // namespace
}  // namespace glidar::stereo::GLIDAR_KERNEL
