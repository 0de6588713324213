// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Inner loops that select the winner of each pixel. Included by kernel.cpp only.
#include <glidar/stereo/kernel.hpp>
#include <glidar/stereo/simd.hpp>

namespace glidar::stereo::GLIDAR_KERNEL {
namespace {

constexpr int kGreatestSum = 32767;

/// The lanes of the last block that are beyond the search have the greatest sum.
struct BeyondSums {
  std::int16_t lane[kLaneBlock];
  BeyondSums(std::size_t disparities, std::size_t lanes) {
    const std::size_t begin = lanes - kLaneBlock;
    for (std::size_t i = 0; i < kLaneBlock; ++i) {
      lane[i] = begin + i < disparities ? -kSumOffset : kGreatestSum;
    }
  }
};

/// The numbers 0, 1, 2 ... of the lanes.
GLIDAR_INLINE Words lane_numbers() {
  Words numbers;
  for (std::size_t i = 0; i < kWords; ++i) numbers[i] = static_cast<std::int16_t>(i);
  return numbers;
}

/// Least sum and first lane that has it.
struct Best {
  Words sum = broadcast(kGreatestSum);
  Words lane = broadcast(kGreatestSum);

  GLIDAR_INLINE void add(Words sums, Words lanes) {
    lane = select_below(sums, sum, lanes, lane);
    sum = min(sums, sum);
  }
  [[nodiscard]] GLIDAR_INLINE int first_lane(int lowest) const {
    return least(select_below(broadcast(lowest), sum, broadcast(kGreatestSum), lane));
  }
};

/// The greatest sum that rivals a least sum: S (100 - percent) <= 100 best, both without offset.
int rival_limit(int best, std::uint32_t uniqueness_percent) {
  const std::uint32_t sum = static_cast<std::uint32_t>(best + kSumOffset);
  const std::uint32_t limit = sum * 100 / (100 - uniqueness_percent);
  const std::uint32_t greatest = kGreatestSum - 1 + kSumOffset;  // not lanes beyond the search
  return static_cast<int>(limit < greatest ? limit : greatest) - kSumOffset;
}

int count_rivals(const WinnerRow& row, const std::int16_t* sum, int limit) {
  const Words above = broadcast(limit + 1);
  Words count = {};
  for (std::size_t d = 0; d < row.lanes; d += kWords) {
    count += select_below(load(sum + d), above, broadcast(1), Words{});
  }
  int total = 0;
  for (std::size_t i = 0; i < kWords; ++i) total += count[i];
  return total;
}

/// Lanes beyond the search count as rivals only if a wrapped sum is low; these are taken off.
int count_beyond(const WinnerRow& row, const std::int16_t* sum, int limit) {
  int count = 0;
  for (std::size_t d = row.disparities; d < row.lanes; ++d) count += sum[d] <= limit ? 1 : 0;
  return count;
}

/// The winner of a pixel, which also competes for the right pixels that it may match.
GLIDAR_INLINE Best find_best(const WinnerRow& row, const BeyondSums& beyond,
                             const std::int16_t* sum, std::size_t x) {
  const std::size_t mirrored = row.width - 1 - x;
  std::int16_t* const mirror_best = row.mirror_best + mirrored;
  std::int16_t* const mirror_winner = row.mirror_winner + mirrored;
  const std::size_t last = row.lanes - kLaneBlock;
  Best best;
  Words lanes = lane_numbers();
  for (std::size_t d = 0; d < row.lanes; d += kWords) {
    Words sums = load(sum + d);
    if (d >= last) sums = max(sums, load(beyond.lane + (d - last)));
    best.add(sums, lanes);
    const Words rival = load(mirror_best + d);
    store(mirror_winner + d, select_below(sums, rival, lanes, load(mirror_winner + d)));
    store(mirror_best + d, min(sums, rival));
    lanes += broadcast(kWords);
  }
  return best;
}

void win_row(const WinnerRow& row) {
  const BeyondSums beyond(row.disparities, row.lanes);
  for (std::size_t i = 0; i < row.width + row.lanes; ++i) row.mirror_best[i] = kGreatestSum;
  for (std::size_t x = 0; x < row.width; ++x) {
    const std::int16_t* const sum = row.sum + x * row.lanes;
    const Best best = find_best(row, beyond, sum, x);
    const int lowest = least(best.sum);
    row.best[x] = static_cast<std::int16_t>(lowest);
    row.winner[x] = static_cast<std::int16_t>(best.first_lane(lowest));
    if (row.uniqueness_percent == 0) continue;
    const int limit = rival_limit(lowest, row.uniqueness_percent);
    row.rivals[x] =
        static_cast<std::int16_t>(count_rivals(row, sum, limit) - count_beyond(row, sum, limit));
  }
}

}  // namespace
}  // namespace glidar::stereo::GLIDAR_KERNEL
