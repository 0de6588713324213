// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/tile_plan.hpp>

#include <algorithm>

namespace glidar::opengl {
namespace {

/// Larger batches save no more waiting, but exceed the processor's cache.
constexpr std::size_t kMaxBatchPixels = 512UL * 512UL;
constexpr std::uint32_t kMaxBatchTiles = 64;  // OpenGL 3.3 guarantees 256 layers

bool fits_batch(const RenderTile& tile, const RenderTile& first, std::uint32_t count) {
  const std::size_t pixels = std::size_t{first.rect.rows} * first.rect.cols;
  return tile.rect.rows == first.rect.rows && tile.rect.cols == first.rect.cols &&
         count < kMaxBatchTiles && (count + 1) * pixels <= kMaxBatchPixels;
}

}  // namespace

void add_tiles(const Beams& beams, std::size_t cast, const DepthRange& depths,
               std::vector<RenderTile>& tiles) {
  constexpr std::uint32_t kSide = 2048;  // OpenGL 3.3 guarantees 1024
  for (std::uint32_t row = 0; row < beams.rows; row += kSide) {
    for (std::uint32_t col = 0; col < beams.cols; col += kSide) {
      tiles.push_back(
          {cast,
           {row, col, std::min(kSide, beams.rows - row), std::min(kSide, beams.cols - col)},
           depths});
    }
  }
}

void group_tiles(std::span<const RenderTile> tiles, std::vector<TileBatch>& batches) {
  batches.clear();
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (!batches.empty() &&
        fits_batch(tiles[i], tiles[batches.back().first], batches.back().count)) {
      ++batches.back().count;
    } else {
      batches.push_back({i, 1});
    }
  }
}

}  // namespace glidar::opengl
