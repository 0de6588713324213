// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth/decimation.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace glidar::depth {
namespace {

constexpr std::size_t kMaxMedianSide = 3;
constexpr std::size_t kMaxSide = 8;

/// The depths of a block, without holes.
struct Block {
  std::array<std::uint16_t, kMaxSide * kMaxSide> depth;
  std::size_t count = 0;
};

Block collect_block(const std::uint16_t* corner, std::size_t side, std::size_t stride) {
  Block block;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const std::uint16_t depth = corner[y * stride + x];
      if (depth != 0) block.depth[block.count++] = depth;
    }
  }
  return block;
}

/// Of an even number, the lower one of the two in the middle.
std::uint16_t median(Block& block) {
  const auto middle = block.depth.begin() + static_cast<std::ptrdiff_t>((block.count - 1) / 2);
  std::nth_element(block.depth.begin(), middle,
                   block.depth.begin() + static_cast<std::ptrdiff_t>(block.count));
  return *middle;
}

std::uint16_t mean(const Block& block) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < block.count; ++i) sum += block.depth[i];
  return static_cast<std::uint16_t>(sum / block.count);
}

std::size_t multiple_of_4(std::size_t size) {
  return (size + 3) / 4 * 4;
}

}  // namespace

void apply(const DecimationFilter& filter, FilterImage& image) {
  const std::size_t side = filter.magnitude;
  const auto& depth = std::get<std::vector<std::uint16_t>>(image.values);
  const std::size_t columns = image.width / side;
  const std::size_t rows = image.height / side;
  if (columns == 0 || rows == 0) {
    throw Error({"depth filter decimation",
                 "the image has " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + " pixels, less than one block",
                 "at least " + std::to_string(side) + " rows and columns",
                 "use a smaller magnitude"});
  }
  const std::size_t width = multiple_of_4(columns);
  std::vector<std::uint16_t> decimated(width * multiple_of_4(rows), 0);
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      Block block = collect_block(depth.data() + (y * image.width + x) * side, side, image.width);
      if (block.count == 0) continue;
      decimated[y * width + x] = side <= kMaxMedianSide ? median(block) : mean(block);
    }
  }
  image.width = width;
  image.height = multiple_of_4(rows);
  image.focal_length_px /= static_cast<float>(side);
  image.values = std::move(decimated);
}

}  // namespace glidar::depth
