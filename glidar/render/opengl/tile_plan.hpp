// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/opengl/projection.hpp>
#include <glidar/render/opengl/triangle_id_target.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace glidar::opengl {

/// A picture to draw: all of a cast's, or a part of it that fits a target.
struct RenderTile {
  std::size_t cast;  ///< which of the batch
  PixelRect rect;
  DepthRange depths;
};

/// Pictures of one size that share a target: [first, first + count) of all.
struct TileBatch {
  std::size_t first;
  std::uint32_t count;
};

/// Adds the parts of a cast's picture, row by row of parts.
void add_tiles(const Beams& beams, std::size_t cast, const DepthRange& depths,
               std::vector<RenderTile>& tiles);

/// Puts pictures that follow each other and have one size together, as many as are worth while.
void group_tiles(std::span<const RenderTile> tiles, std::vector<TileBatch>& batches);

inline TileSize size_of(std::span<const RenderTile> tiles, const TileBatch& batch) {
  const PixelRect& rect = tiles[batch.first].rect;
  return {rect.rows, rect.cols, batch.count};
}

}  // namespace glidar::opengl
