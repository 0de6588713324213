// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace glidar::opengl {

/// A cast's image, or a tile of it that fits a target.
struct RenderTile {
  std::size_t cast;  ///< index in the batch of casts
  PixelRect rect;
  DepthRange depths;
};

/// Consecutive tiles of one size that share a target: [first, first + count).
struct TileBatch {
  std::size_t first;
  std::uint32_t count;
};

/// Adds the tiles of a cast's image, row by row.
void add_tiles(const Beams& beams, std::size_t cast, const DepthRange& depths,
               std::vector<RenderTile>& tiles);

/// Groups consecutive tiles of one size into batches of limited size.
void group_tiles(std::span<const RenderTile> tiles, std::vector<TileBatch>& batches);

inline TileSize size_of(std::span<const RenderTile> tiles, const TileBatch& batch) {
  const PixelRect& rect = tiles[batch.first].rect;
  return {rect.rows, rect.cols, batch.count};
}

}  // namespace glidar::opengl
