// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/leaf_test.hpp>
#include <glidar/render/scan_raster/large_triangle.hpp>

// Draws the triangles of a cluster: finds the cells that they cover, and tests the cells' beams.
namespace glidar::rays::GLIDAR_KERNEL {

/// Triangles with more vectors of cells than this are drawn by tiles.
inline constexpr std::int32_t kSmallTriangle = 16;

/// The sector's origin relative to a cluster.
struct LeafOrigin {
  float at[3];
  float scaled;   ///< see scaled_reach()
  float foot[3];  ///< Placement::foot plus the rounding of positions in the sector's frame
  float behind;

  GLIDAR_INLINE LeafOrigin(const Placement& placement, const TriangleCluster& cluster) {
    double largest = 0.0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double x = placement.origin[axis] - static_cast<double>(cluster.centre[axis]);
      at[axis] = static_cast<float>(x);
      largest = larger(largest, __builtin_fabs(x));
    }
    const double reach = largest + static_cast<double>(cluster.radius) +
                         2.0 * static_cast<double>(placement.distance) +
                         placement.rounding * 0x1p-26;
    scaled = scaled_reach(reach);
    // Some 24 roundings of 2^-24: of the corner, of its edges, and of transforming both.
    const auto margin = static_cast<float>(0x1p-19 * (reach + kReachMargin));
    for (unsigned axis = 0; axis < 3; ++axis) foot[axis] = placement.foot[axis] + margin;
    behind = placement.behind + foot[0];
  }
};

/// Eight triangles in the frame of slopes.
struct ProjectedBlock {
  Vector<Float8> corner[3];
  Vector<Float8> e1;
  Vector<Float8> e2;

  GLIDAR_INLINE ProjectedBlock(const FrameTransform& transform, const Vector<Float8>& a,
                               const Corners<Float8>& corners)
      : e1(transform(corners.e1)), e2(transform(corners.e2)) {
    corner[0] = transform(a);
    corner[1] = sum(corner[0], e1);
    corner[2] = sum(corner[0], e2);
  }

  GLIDAR_INLINE static Vector<Float8> sum(const Vector<Float8>& p, const Vector<Float8>& q) {
    return {p.x + q.x, p.y + q.y, p.z + q.z};
  }
  template <class Of>
  [[nodiscard]] GLIDAR_INLINE Float8 lowest(const Of& of) const {
    return min(min(of(corner[0]), of(corner[1])), of(corner[2]));
  }
  template <class Of>
  [[nodiscard]] GLIDAR_INLINE Float8 highest(const Of& of) const {
    return max(max(of(corner[0]), of(corner[1])), of(corner[2]));
  }
};

/// Bits of the triangles that are beside, above or below the sector. For triangles with a corner
/// that is not in front.
GLIDAR_INLINE std::uint32_t find_outside(const GridView& grid, const ProjectedBlock& projected,
                                         const LeafOrigin& origin) {
  using V = Vector<Float8>;
  const Float8 side = Float8::all(grid.max_slope);
  const Float8 high = Float8::all(grid.highest_slope);
  const Float8 low = Float8::all(grid.lowest_slope);
  const auto margin_at = [&](float foot, float slope) {
    const float size = slope < 0.0F ? -slope : slope;
    return Float8::all(foot + size * origin.foot[0] + (1.0F + size) * origin.behind);
  };
  const Float8 side_margin = margin_at(origin.foot[1], grid.max_slope);
  return bits((projected.lowest([&](const V& p) { return p.y - side * p.x; }) > side_margin) |
              (projected.highest([&](const V& p) { return p.y + side * p.x; }) < -side_margin) |
              (projected.lowest([&](const V& p) { return p.z - high * p.x; }) >
               margin_at(origin.foot[2], grid.highest_slope)) |
              (projected.highest([&](const V& p) { return p.z - low * p.x; }) <
               -margin_at(origin.foot[2], grid.lowest_slope)));
}

/// The slopes of triangles whose corners are all in front by twice the foot's depth. A corner seen
/// from h beside the origin has another slope s, by at most (h_side + |s| h_forward) / (z - h).
GLIDAR_INLINE Slopes slopes_of(const ProjectedBlock& projected, const LeafOrigin& origin,
                               Float8 forward) {
  const Float8 one = Float8::all(1.0F);
  const Float8 min_forward = Float8::all(2.0F * origin.foot[0]);
  Float8 side[3];
  Float8 up[3];
  for (unsigned k = 0; k < 3; ++k) {
    const Float8 inverse = one / max(projected.corner[k].x, min_forward);
    side[k] = projected.corner[k].y * inverse;
    up[k] = projected.corner[k].z * inverse;
  }
  const Float8 inverse = one / max(forward, min_forward);
  const Float8 nearness = inverse * multiply_add(inverse, min_forward, one);
  const auto low = [](const Float8(&s)[3]) { return min(min(s[0], s[1]), s[2]); };
  const auto high = [](const Float8(&s)[3]) { return max(max(s[0], s[1]), s[2]); };
  Slopes slopes = {low(side), high(side), low(up), high(up)};
  const auto widen = [&](float foot, Float8& first, Float8& last) {
    const Float8 largest = max(magnitude(first), magnitude(last));
    const Float8 by =
        nearness * multiply_add(largest, Float8::all(origin.foot[0]), Float8::all(foot));
    first = first - by;
    last = last + by;
  };
  widen(origin.foot[1], slopes.side_low, slopes.side_high);
  widen(origin.foot[2], slopes.up_low, slopes.up_high);
  return slopes;
}

/// The remaining triangles of eight, and their cells.
struct BlockCells {
  std::uint32_t left;
  std::uint32_t around;  ///< those that may cover any cell
  CellRects rects;

  template <class Cells>
  GLIDAR_INLINE static BlockCells find(const DrawContext& context, const ProjectedBlock& projected,
                                       const LeafOrigin& origin, std::uint32_t existing) {
    BlockCells cells;
    const auto forward = [](const Vector<Float8>& p) { return p.x; };
    const Float8 nearest = projected.lowest(forward);
    const std::uint32_t behind = bits(projected.highest(forward) < Float8::all(-origin.behind));
    cells.left = existing & ~behind;
    cells.around = bits(nearest < Float8::all(2.0F * origin.foot[0])) & cells.left;
    if (cells.around != 0) {
      const std::uint32_t beside = find_outside(context.grid, projected, origin) & cells.around;
      cells.around &= ~beside;
      cells.left &= ~beside;
    }
    if (cells.left == 0) return cells;
    const Slopes slopes = slopes_of(projected, origin, nearest);
    cells.left &= cells.around | Cells::find(context.grid, slopes, cells.rects);
    return cells;
  }
};

/// The rows of the triangles, with signs flipped so that det is positive. With separate origins,
/// `seen` is in the sector's frame.
template <bool kOwnOrigins>
GLIDAR_INLINE void fill_rows(const DrawContext& context, const BlockSetup& s,
                             const ProjectedBlock& projected, TriangleRows& rows) {
  const auto metres = static_cast<float>(context.placement.metres);
  const Float8 scale = Float8::all(metres);
  rows.set(TriangleRows::kQ1, flip_sign(context.rotation(s.q1), s.det));
  rows.set(TriangleRows::kQ2, flip_sign(context.rotation(s.q2), s.det));
  rows.set(TriangleRows::kN, flip_sign(context.rotation(s.n), s.det));
  const Float8 det = magnitude(s.det) * scale;
  rows.set(TriangleRows::kDet, det);
  const Float8 transformed = Float8::all(kTransformMargin);
  rows.set(TriangleRows::kEdgeBound, s.bounds.edge * transformed);
  rows.set(TriangleRows::kDetBound,
           multiply_add(s.bounds.det, Float8::all(1.001F * metres), det * Float8::all(0x1p-22F)));
  rows.set(TriangleRows::kDenBound, s.bounds.den * transformed);
  if constexpr (kOwnOrigins) {
    const Float8 inverse = Float8::all(1.0F / metres);
    const auto scaled = [&](const Vector<Float8>& e) {
      const Vector<Float8> flipped_e = flip_sign(e, s.det);
      return Vector<Float8>{flipped_e.x * inverse, flipped_e.y * inverse, flipped_e.z * inverse};
    };
    rows.set(TriangleRows::kE1, scaled(projected.e1));
    rows.set(TriangleRows::kE2, scaled(projected.e2));
  }
}

/// Bits of the triangles that all beams see from the same side.
template <bool kOwnOrigins>
GLIDAR_INLINE std::uint32_t find_facing(const DrawContext& context, const TriangleRows& rows) {
  Float8 bound = Float8::load(rows.at[TriangleRows::kDetBound]);
  if constexpr (kOwnOrigins) {
    constexpr float kMargin = 1.001F;
    const Vector<Float8> n = {Float8::load(rows.at[TriangleRows::kN]),
                              Float8::load(rows.at[TriangleRows::kN + 1]),
                              Float8::load(rows.at[TriangleRows::kN + 2])};
    bound =
        multiply_add(largest_product(context.sector.max_offset, n), Float8::all(kMargin), bound);
  }
  return bits(Float8::load(rows.at[TriangleRows::kDet]) > bound);
}

/// Draws a triangle of few cells, eight columns at a time.
template <bool kOwnOrigins>
GLIDAR_INLINE void draw_small(const DrawContext& context, const RowTriangle& t,
                              const CellRects& rects, CellRect rect) {
  const GridView& grid = context.grid;
  const std::uint32_t last_tile = grid.columns / kTileColumns - 1;
  for (std::int32_t row = rect.first_row; row <= rect.last_row; ++row) {
    rects.cut(grid, t.index, grid.low_deviation[row], grid.high_deviation[row], rect);
    std::uint32_t* stale = context.buffer.is_stale +
                           static_cast<std::size_t>(row) / kTileRows * std::size_t{grid.tile_pitch};
    for (auto column = static_cast<std::uint32_t>(rect.first_column);
         static_cast<std::int32_t>(column) <= rect.last_column; column += kTileColumns) {
      const std::uint32_t next = column / kTileColumns + 1;
      stale[column / kTileColumns] = 1;
      stale[next < last_tile ? next : last_tile] = 1;
      test_cells<kOwnOrigins>(context, t, static_cast<std::size_t>(row) * grid.pitch + column);
    }
  }
}

template <class Cells, bool kOwnOrigins>
GLIDAR_INLINE void draw_triangle(const DrawContext& context, const RowTriangle& t,
                                 const BlockCells& cells) {
  if ((cells.around >> t.index & 1U) != 0) {
    draw_large<kOwnOrigins>(context, t, whole_sector(context.grid));
    return;
  }
  const CellRect rect = cells.rects.at<Cells>(context.grid, t.index);
  if (rect.is_empty()) return;
  const std::int32_t rows = rect.last_row - rect.first_row + 1;
  const std::int32_t vectors = (rect.last_column - rect.first_column) / 8 + 1;
  if (rows * vectors <= kSmallTriangle) {
    draw_small<kOwnOrigins>(context, t, cells.rects, rect);
  } else {
    draw_large<kOwnOrigins>(context, t, rect);
  }
}

template <class Cells, bool kOwnOrigins>
void draw_leaf(const DrawContext& context, std::uint32_t index) {
  const TreeView& tree = context.placement.tree;
  const TriangleCluster& cluster = tree.clusters[index];
  const LeafOrigin origin(context.placement, cluster);
  for (std::uint32_t b = 0; b < block_count(cluster.count); ++b) {
    const std::uint32_t block = cluster.first_block + b;
    const Corners<Float8> corners = corners_in(tree.blocks[block], cluster);
    const Vector<Float8> a =
        corners.a - Vector<Float8>{Float8::all(origin.at[0]), Float8::all(origin.at[1]),
                                   Float8::all(origin.at[2])};
    const ProjectedBlock projected(slopes_frame<Cells>(context), a, corners);
    const auto cells = BlockCells::find<Cells>(context, projected, origin, present(cluster, b));
    if (cells.left == 0) continue;
    const BlockSetup s = set_up(corners, a, origin.scaled);
    TriangleRows rows;
    fill_rows<kOwnOrigins>(context, s, projected, rows);
    const std::uint32_t faces = find_facing<kOwnOrigins>(context, rows);
    for_bits(cells.left, [&](unsigned i) {
      draw_triangle<Cells, kOwnOrigins>(
          context, {rows, i, block * kBlockSize + i, (faces >> i & 1U) != 0}, cells);
    });
  }
}

}  // namespace glidar::rays::GLIDAR_KERNEL
