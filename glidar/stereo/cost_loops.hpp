// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Inner loops from pixels to matching costs. Included by kernel.cpp only.
#include <glidar/stereo/kernel.hpp>
#include <glidar/stereo/simd.hpp>

namespace glidar::stereo::GLIDAR_KERNEL {
namespace {

/// The bits [begin, end) of the pixels from `centre` on, one pixel in each lane.
GLIDAR_INLINE Words census_bits(const CensusRow& row, const std::int16_t* centre, std::size_t begin,
                                std::size_t end) {
  Words bits = {};
  Words value = broadcast(1);
  for (std::size_t bit = begin; bit < end; ++bit) {
    bits |=
        select_below(load(centre + row.first[bit]), load(centre + row.second[bit]), value, Words{});
    value += value;
  }
  return bits;
}

void census_row(const CensusRow& row) {
  for (std::size_t begin = 0; begin < row.bits; begin += kPlaneBits) {
    const std::size_t end = begin + kPlaneBits < row.bits ? begin + kPlaneBits : row.bits;
    std::uint8_t* const plane = row.planes + begin / kPlaneBits * row.plane_stride;
    for (std::size_t x = 0; x < row.width; x += kWords)
      store_narrowed(plane + x, census_bits(row, row.centre + x, begin, end));
  }
}

/// Lanes whose pixel is outside the right image.
GLIDAR_INLINE void fill_outside(const HammingRow& row, std::size_t x, std::uint8_t* distances) {
  const std::size_t inside = x >= row.min_disparity ? x - row.min_disparity + 1 : 0;
  for (std::size_t d = inside; d < row.lanes; ++d) distances[d] = row.outside;
}

template <std::size_t kPlanes>
void hamming_pixel(const HammingRow& row, std::size_t x, std::uint8_t* distances) {
  Bytes left[kPlanes];
  for (std::size_t p = 0; p < kPlanes; ++p) {
    left[p] = broadcast_byte(row.left[p * row.left_stride + x]);
  }
  const std::uint8_t* const right = row.right + (row.width - 1 - x) + row.min_disparity;
  for (std::size_t d = 0; d < row.lanes; d += kVectorBytes) {
    Bytes total = {};
    for (std::size_t p = 0; p < kPlanes; ++p) {
      total += bit_counts(left[p] ^ load(right + p * row.right_stride + d));
    }
    store(distances + d, total);
  }
}

template <std::size_t kPlanes>
void hamming_planes(const HammingRow& row) {
  for (std::size_t x = 0; x < row.width; ++x) {
    std::uint8_t* const distances = row.distances + x * row.lanes;
    hamming_pixel<kPlanes>(row, x, distances);
    fill_outside(row, x, distances);
  }
}

void hamming_row(const HammingRow& row) {
  if (row.planes == 3) return hamming_planes<3>(row);
  if (row.planes == 6) return hamming_planes<6>(row);
  hamming_planes<kMaxPlanes>(row);
}

void add_row(std::int16_t* total, const std::uint8_t* added, std::size_t count) {
  for (std::size_t i = 0; i < count; i += kWords) {
    store(total + i, load(total + i) + load_widened(added + i));
  }
}

void slide_rows(std::int16_t* total, const std::uint8_t* added, const std::uint8_t* removed,
                std::size_t count) {
  for (std::size_t i = 0; i < count; i += kWords) {
    store(total + i, load(total + i) + load_widened(added + i) - load_widened(removed + i));
  }
}

void box_row(const std::int16_t* total, std::int16_t* cost, std::size_t width, std::size_t lanes,
             std::size_t radius) {
  const std::size_t last = width - 1;
  for (std::size_t d = 0; d < lanes; d += kWords) {  // pixel 0
    Words sum = load(total + d);
    for (std::size_t i = 1; i <= radius; ++i) {
      sum += load(total + d) + load(total + (i < last ? i : last) * lanes + d);
    }
    store(cost + d, sum);
  }
  for (std::size_t x = 1; x < width; ++x) {
    const std::size_t added = x + radius < last ? x + radius : last;
    const std::size_t removed = x > radius ? x - 1 - radius : 0;
    const std::int16_t* const before = cost + (x - 1) * lanes;
    for (std::size_t d = 0; d < lanes; d += kWords) {
      store(cost + x * lanes + d,
            load(before + d) + load(total + added * lanes + d) - load(total + removed * lanes + d));
    }
  }
}

}  // namespace
}  // namespace glidar::stereo::GLIDAR_KERNEL
