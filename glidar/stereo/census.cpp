// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/census.hpp>

#include <algorithm>

namespace glidar::stereo {

namespace {

/// Levels minus 32768 with a border of repeated edge pixels on all sides.
struct PaddedImage {
  std::size_t stride = 0;
  std::vector<std::int16_t> level;
};

PaddedImage padded(const GreyImage& image, std::size_t radius, bool is_mirrored) {
  PaddedImage result;
  result.stride = image.width + 2 * radius + kLaneBlock;
  result.level.resize(result.stride * (image.height + 2 * radius));
  for (std::size_t row = 0; row < image.height + 2 * radius; ++row) {
    const std::size_t y = std::min<std::size_t>(std::max(row, radius) - radius, image.height - 1);
    const std::uint16_t* const from = image.level.data() + y * image.width;
    std::int16_t* const to = result.level.data() + row * result.stride;
    for (std::size_t column = 0; column < image.width + 2 * radius; ++column) {
      const std::size_t x =
          std::min<std::size_t>(std::max(column, radius) - radius, image.width - 1);
      const std::size_t source = is_mirrored ? image.width - 1 - x : x;
      to[column] = static_cast<std::int16_t>(from[source] - kSumOffset);
    }
  }
  return result;
}

/// Offsets of the pixels that are compared, one pair for each bit.
struct Pairs {
  std::vector<std::ptrdiff_t> first;
  std::vector<std::ptrdiff_t> second;
};

Pairs make_pairs(StereoCensus kind, bool is_mirrored, std::size_t stride) {
  Pairs pairs;
  const bool is_symmetric = kind == StereoCensus::symmetric_7x7;
  const auto radius = static_cast<std::ptrdiff_t>(census_radius_px(kind));
  const std::ptrdiff_t side = 2 * radius + 1;
  const std::ptrdiff_t centre = side * side / 2;
  // of a symmetric census only the pixels before the centre: the others are opposite
  for (std::ptrdiff_t i = 0; i < (is_symmetric ? centre : side * side); ++i) {
    if (i == centre) continue;
    const std::ptrdiff_t dx = i % side - radius;
    const std::ptrdiff_t dy = i / side - radius;
    const std::ptrdiff_t offset =
        dy * static_cast<std::ptrdiff_t>(stride) + (is_mirrored ? -dx : dx);
    pairs.first.push_back(offset);
    pairs.second.push_back(is_symmetric ? -offset : 0);
  }
  return pairs;
}

}  // namespace

Census make_census(const GreyImage& image, StereoCensus kind, bool is_mirrored, std::size_t padding,
                   const Kernel& kernel) {
  const std::size_t radius = census_radius_px(kind);
  const PaddedImage source = padded(image, radius, is_mirrored);
  const Pairs pairs = make_pairs(kind, is_mirrored, source.stride);
  Census census;
  census.planes = pairs.first.size() / kPlaneBits;
  census.plane_stride = image.width + kLaneBlock + padding;
  census.bytes.resize(census.planes * census.plane_stride * image.height);
  for (std::size_t y = 0; y < image.height; ++y) {
    kernel.census({.centre = source.level.data() + (y + radius) * source.stride + radius,
                   .first = pairs.first.data(),
                   .second = pairs.second.data(),
                   .bits = pairs.first.size(),
                   .width = image.width,
                   .planes = census.bytes.data() + y * census.planes * census.plane_stride,
                   .plane_stride = census.plane_stride});
  }
  return census;
}

}  // namespace glidar::stereo
