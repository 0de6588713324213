// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/tile_depths.hpp>

// Tests a triangle that covers many cells: eight tiles at once, then the cells of the remaining
// tiles.
namespace glidar::rays::GLIDAR_KERNEL {

/// How far edge functions and det of beams may differ from those of a beam through the origin.
struct OriginSpread {
  Float8 v;
  Float8 u;
  Float8 w;
  Float8 det;
};

GLIDAR_INLINE Float8 largest_product(const float (&sizes)[3], const Vector<Float8>& v) {
  return dot(FrameTransform::row(sizes), magnitude(v));
}

template <bool kOwnOrigins>
GLIDAR_INLINE OriginSpread spread_of(const DrawContext& context, const RowTriangle& t) {
  const Float8 zero = Float8::all(0.0F);
  if constexpr (!kOwnOrigins) return {zero, zero, zero, zero};
  const Float8 margin = Float8::all(1.0F + 0x1p-20F);
  const Float8 v =
      margin * largest_product(context.sector.max_moment, t.rows.all3(TriangleRows::kE1, t.index));
  const Float8 u =
      margin * largest_product(context.sector.max_moment, t.rows.all3(TriangleRows::kE2, t.index));
  const Float8 det =
      margin * largest_product(context.sector.max_offset, t.rows.all3(TriangleRows::kN, t.index));
  return {v, u, u + v, det};
}

/// Bounds of the products of a vector and all directions, for eight tiles.
struct TileProducts {
  Float8 low;
  Float8 high;

  GLIDAR_INLINE TileProducts(const SectorView& sector, std::size_t tile, const Vector<Float8>& q) {
    const Float8 middle = dot(load3(sector.tile_middle, tile), q);
    const Float8 half = dot(load3(sector.tile_half, tile), magnitude(q));
    low = middle - half;
    high = middle + half;
  }
};

/// Bits of eight tiles.
struct TileTest {
  std::uint32_t outside;  ///< no beam hits, or all have a nearer hit
  std::uint32_t inside;   ///< all beams pass inside of the edges
};

template <bool kOwnOrigins>
GLIDAR_INLINE TileTest test_tiles(const DrawContext& context, const RowTriangle& t,
                                  const OriginSpread& spread, std::size_t tile) {
  const Vector<Float8> q1 = t.rows.all3(TriangleRows::kQ1, t.index);
  const Vector<Float8> q2 = t.rows.all3(TriangleRows::kQ2, t.index);
  const Vector<Float8> n = t.rows.all3(TriangleRows::kN, t.index);
  const ErrorBounds<Float8> bounds = t.rows.error_bounds(t.index);
  const TileProducts v(context.sector, tile, q1);
  const TileProducts u(context.sector, tile, q2);
  const TileProducts w(context.sector, tile, n - q1 - q2);
  const TileProducts den(context.sector, tile, n);
  const Float8 highest = min(min(v.high + spread.v, u.high + spread.u), w.high + spread.w);
  const Float8 lowest = min(min(v.low - spread.v, u.low - spread.u), w.low - spread.w);
  const Float8 margin = bounds.edge * Float8::all(2.0F);
  // The nearest distance is that of the smallest det and the largest den.
  const Float8 det =
      t.rows.all(TriangleRows::kDet, t.index) - spread.det - bounds.det * Float8::all(2.0F);
  const Float8 largest_den = den.high + bounds.den * Float8::all(2.0F);
  const Float8 nearest = det / largest_den * Float8::all(1.0F - 0x1p-20F);
  const Mask8 is_hidden = (largest_den > Float8::all(0.0F)) &
                          (Float8::load_unaligned(context.buffer.farthest + tile) < nearest);
  return {bits((highest < -margin) | is_hidden), bits(margin < lowest)};
}

/// The rows of the rectangle in one tile.
template <bool kOwnOrigins>
GLIDAR_INLINE void test_tile(const DrawContext& context, const RowTriangle& t, const CellRect& rect,
                             std::uint32_t tile_row, std::uint32_t tile_column, bool is_inside) {
  const auto top = static_cast<std::int32_t>(tile_row * kTileRows);
  const std::int32_t first = top > rect.first_row ? top : rect.first_row;
  const std::int32_t bottom = top + static_cast<std::int32_t>(kTileRows) - 1;
  const std::int32_t last = bottom < rect.last_row ? bottom : rect.last_row;
  const std::size_t pitch = context.grid.pitch;
  std::size_t cell =
      static_cast<std::size_t>(first) * pitch + std::size_t{tile_column} * kTileColumns;
  for (std::int32_t row = first; row <= last; ++row, cell += pitch) {
    if (is_inside) {
      test_inside<kOwnOrigins>(context, t, cell);
    } else {
      test_cells<kOwnOrigins>(context, t, cell);
    }
  }
}

/// Bits of the tiles [first, last] among eight that begin at `base`.
GLIDAR_INLINE std::uint32_t tiles_between(std::uint32_t base, std::uint32_t first,
                                          std::uint32_t last) {
  std::uint32_t all = 0xFF;
  if (first > base) all &= 0xFFU << (first - base);
  if (last < base + 7) all &= 0xFFU >> (base + 7 - last);
  return all;
}

/// Eight tiles side by side, of which the bits of `left` are in the rectangle.
template <bool kOwnOrigins>
GLIDAR_INLINE void draw_tiles(const DrawContext& context, const RowTriangle& t,
                              const CellRect& rect, const OriginSpread& spread, std::size_t tile,
                              std::uint32_t left) {
  std::uint32_t inside = 0;
  if (t.faces) {
    const TileTest test = test_tiles<kOwnOrigins>(context, t, spread, tile);
    left &= ~test.outside;
    inside = test.inside;
  }
  const auto row = static_cast<std::uint32_t>(tile / context.grid.tile_pitch);
  const auto base = static_cast<std::uint32_t>(tile % context.grid.tile_pitch);
  for (; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(left));
    context.buffer.is_stale[tile + i] = 1;
    test_tile<kOwnOrigins>(context, t, rect, row, base + i, (inside >> i & 1U) != 0);
  }
}

template <bool kOwnOrigins>
void draw_large(const DrawContext& context, const RowTriangle& t, const CellRect& rect) {
  const TileRect tiles = tiles_of(rect);
  const OriginSpread spread = spread_of<kOwnOrigins>(context, t);
  for (std::uint32_t row = tiles.first_row; row <= tiles.last_row; ++row) {
    for (std::uint32_t base = tiles.first_column & ~7U; base <= tiles.last_column; base += 8) {
      draw_tiles<kOwnOrigins>(context, t, rect, spread,
                              std::size_t{row} * context.grid.tile_pitch + base,
                              tiles_between(base, tiles.first_column, tiles.last_column));
    }
  }
}

}  // namespace glidar::rays::GLIDAR_KERNEL
