// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/cell_test.hpp>

// Maximum distances in a sector's tiles, for occlusion tests.
namespace glidar::rays::GLIDAR_KERNEL {

using scan_raster::kTileColumns;
using scan_raster::kTileRows;

/// A rectangle of tiles, both ends included.
struct TileRect {
  std::uint8_t first_column;
  std::uint8_t last_column;
  std::uint16_t first_row;
  std::uint16_t last_row;
};

GLIDAR_INLINE TileRect tiles_of(const CellRect& rect) {
  return {static_cast<std::uint8_t>(rect.first_column / static_cast<int>(kTileColumns)),
          static_cast<std::uint8_t>(rect.last_column / static_cast<int>(kTileColumns)),
          static_cast<std::uint16_t>(rect.first_row / static_cast<int>(kTileRows)),
          static_cast<std::uint16_t>(rect.last_row / static_cast<int>(kTileRows))};
}

/// The maximum distance in a tile.
inline float farthest_in(const DrawContext& context, std::uint32_t row, std::uint32_t column) {
  const std::size_t pitch = context.grid.pitch;
  const float* high = context.buffer.high + std::size_t{row} * kTileRows * pitch +
                      std::size_t{column} * kTileColumns;
  Float8 largest = Float8::load_unaligned(high);
  for (unsigned i = 1; i < kTileRows; ++i)
    largest = max(largest, Float8::load_unaligned(high + i * pitch));
  return -min_of(-largest);
}

/// True where some tile may still have a hit at this distance.
inline bool is_visible(const DrawContext& context, const TileRect& rect, float distance) {
  const SectorBuffer& buffer = context.buffer;
  for (std::uint32_t row = rect.first_row; row <= rect.last_row; ++row) {
    for (std::uint32_t column = rect.first_column; column <= rect.last_column; ++column) {
      const std::size_t tile = std::size_t{row} * context.grid.tile_pitch + column;
      if (buffer.farthest[tile] < distance) continue;
      if (buffer.is_stale[tile] == 0) return true;
      buffer.is_stale[tile] = 0;
      buffer.farthest[tile] = farthest_in(context, row, column);
      if (!(buffer.farthest[tile] < distance)) return true;
    }
  }
  return false;
}

}  // namespace glidar::rays::GLIDAR_KERNEL
