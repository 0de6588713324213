// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace glidar::stereo {

/// Rows of costs have a multiple of this many lanes per pixel; those beyond the search never win.
inline constexpr std::size_t kLaneBlock = 32;
/// Cost of lanes beyond the search in path costs: above every path cost plus every penalty.
inline constexpr std::int16_t kNoCost = 16383;
/// Sums of path costs are stored minus this, so that signed comparisons order them.
inline constexpr int kSumOffset = 32768;
/// Elements between the path costs of two pixels, beyond their lanes.
inline constexpr std::size_t kStateGap = kLaneBlock;
/// Greatest number of byte planes of a census: 80 bits.
inline constexpr std::size_t kMaxPlanes = 10;
/// Greatest number of bits of a byte plane.
inline constexpr std::size_t kPlaneBits = 8;

/// One row of a census: bit k of plane p at x is set if first[8 p + k] is below second[8 p + k]
/// there. The row has space for kLaneBlock pixels more than `width`.
struct CensusRow {
  const std::int16_t* centre = nullptr;    ///< pixel 0 of the row in the padded image
  const std::ptrdiff_t* first = nullptr;   ///< offsets from the centre, one for each bit
  const std::ptrdiff_t* second = nullptr;  ///< one for each bit
  std::size_t bits = 0;
  std::size_t width = 0;
  std::uint8_t* planes = nullptr;  ///< plane after plane
  std::size_t plane_stride = 0;
};

/// Hamming distances of one row, lane d of pixel x: between x of the left and x - min - d of the
/// right census. Pixels outside the right image have the cost `outside`.
struct HammingRow {
  const std::uint8_t* left = nullptr;   ///< planes of the left row
  const std::uint8_t* right = nullptr;  ///< planes of the mirrored right row
  std::size_t left_stride = 0;          ///< between planes
  std::size_t right_stride = 0;
  std::size_t planes = 0;
  std::size_t width = 0;
  std::size_t lanes = 0;  ///< for each pixel, a multiple of kLaneBlock
  std::size_t min_disparity = 0;
  std::uint8_t outside = 0;
  std::uint8_t* distances = nullptr;  ///< width x lanes
};

/// Path costs along one row, in one direction, added to `sum`.
struct SweepRow {
  const std::int16_t* cost = nullptr;  ///< width x lanes
  std::int16_t* sum = nullptr;         ///< width x lanes, minus kSumOffset
  std::size_t width = 0;
  std::size_t lanes = 0;
  std::size_t disparities = 0;
  std::int16_t p1 = 0;
  std::int16_t p2 = 0;
  bool is_backwards = false;      ///< from the last pixel to the first
  bool is_first = false;          ///< sets `sum` instead
  std::int16_t* state = nullptr;  ///< 2 x (lanes + kStateGap) + kStateGap elements
};

/// Path costs from the row before, for `count` pixels. A path's state has lanes + kStateGap
/// elements for each pixel, behind a gap of kNoCost, and its least cost in `least`; both are
/// replaced.
struct DownRow {
  const std::int16_t* cost = nullptr;  ///< count x lanes
  const std::int16_t* sum = nullptr;   ///< count x lanes, minus kSumOffset
  std::int16_t* new_sum = nullptr;     ///< may be `sum`
  std::size_t count = 0;
  std::size_t lanes = 0;
  std::size_t disparities = 0;
  std::int16_t p1 = 0;
  std::int16_t p2 = 0;
  std::size_t paths = 0;  ///< 1 or 3
  std::int16_t* state[3] = {};
  std::int16_t* least[3] = {};
};

/// The winners of one row of sums.
struct WinnerRow {
  const std::int16_t* sum = nullptr;  ///< width x lanes, minus kSumOffset
  std::size_t width = 0;
  std::size_t lanes = 0;
  std::size_t disparities = 0;
  std::uint32_t uniqueness_percent = 0;
  std::int16_t* best = nullptr;           ///< least sum of each pixel, minus kSumOffset
  std::int16_t* winner = nullptr;         ///< the first lane that has it
  std::int16_t* rivals = nullptr;         ///< lanes whose sum (100 - percent) is at most 100 best
  std::int16_t* mirror_best = nullptr;    ///< width + lanes: work space
  std::int16_t* mirror_winner = nullptr;  ///< width + lanes: lane of right pixel width - 1 - i
};

/// The inner loops, compiled for one instruction set. stereo_kernel.cpp is compiled once for each,
/// with GLIDAR_KERNEL as its name.
struct Kernel {
  const char* name;  ///< "baseline", "avx2", "avx512"
  void (*census)(const CensusRow& row);
  void (*hamming)(const HammingRow& row);
  /// total[i] += added[i]
  void (*add)(std::int16_t* total, const std::uint8_t* added, std::size_t count);
  /// total[i] += added[i] - removed[i]
  void (*slide)(std::int16_t* total, const std::uint8_t* added, const std::uint8_t* removed,
                std::size_t count);
  /// cost at x = sum of `total` at x - radius ... x + radius; beyond the ends, the last pixel
  /// counts
  void (*box)(const std::int16_t* total, std::int16_t* cost, std::size_t width, std::size_t lanes,
              std::size_t radius);
  void (*sweep)(const SweepRow& row);
  void (*down)(const DownRow& row);
  void (*win)(const WinnerRow& row);
};

}  // namespace glidar::stereo
