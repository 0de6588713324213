// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/sample_pair.hpp>

#include <glidar/math/philox.hpp>

#include <cstddef>

namespace glidar {

namespace {

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 200;
constexpr std::int64_t kDiscColumn = 190;  // in the left image
constexpr std::int64_t kDiscRow = 90;
constexpr std::int64_t kDiscRadius = 50;

/// The grey level of a dot pattern: one pixel in four is bright, all have some noise.
std::uint16_t dots(std::int64_t column, std::uint32_t row, std::uint32_t layer) {
  PhiloxState words = {static_cast<std::uint32_t>(column + 1000), row, layer, 0};
  philox_rounds(words, 2026, 8);
  return static_cast<std::uint16_t>((words.c0 % 4 == 0 ? 120U : 30U) + words.c1 % 60U);
}

bool is_disc(std::int64_t column, std::int64_t row) {
  const std::int64_t dx = column - kDiscColumn;
  const std::int64_t dy = row - kDiscRow;
  return dx * dx + dy * dy <= kDiscRadius * kDiscRadius;
}

/// The plane at a column of the left image.
std::uint16_t plane_level(std::int64_t column, std::uint32_t row) {
  const bool is_patch_row = row >= 150 && row < 185;
  if (is_patch_row && column >= 90 && column < 140) return 40;
  if (is_patch_row && column >= 240 && column < 290) return 255;
  return dots(column, row, 0);
}

/// The scene at a column of the left image, for an eye in which the disc is displaced against the
/// plane by `displacement` columns to the left.
std::uint16_t level_at(std::int64_t column, std::uint32_t row, std::int64_t displacement) {
  const std::int64_t on_disc = column + displacement;
  return is_disc(on_disc, row) ? dots(on_disc, row, 1) : plane_level(column, row);
}

}  // namespace

StereoPair sample_stereo_pair() {
  StereoPair pair;
  for (GreyImage* image : {&pair.left, &pair.right}) {
    image->width = kWidth;
    image->height = kHeight;
    image->level.reserve(std::size_t{kWidth} * kHeight);
  }
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    for (std::int64_t column = 0; column < kWidth; ++column) {
      pair.left.level.push_back(level_at(column, row, 0));
      pair.right.level.push_back(
          level_at(column + kSampleFar_px, row, std::int64_t{kSampleNear_px} - kSampleFar_px));
    }
  }
  return pair;
}

}  // namespace glidar
