// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/triangle_filter.hpp>
#include <glidar/render/scan_raster/sector.hpp>

// Finds the cells of a sector that may see a triangle or a box; conservative.
namespace glidar::rays::GLIDAR_KERNEL {

using scan_raster::ElevationRows;
using scan_raster::GridView;
using scan_raster::kElevationBins;

/// Columns and rows, both ends included.
struct CellRect {
  std::int32_t first_column;
  std::int32_t last_column;
  std::int32_t first_row;
  std::int32_t last_row;

  [[nodiscard]] GLIDAR_INLINE bool is_empty() const {
    return first_column > last_column || first_row > last_row;
  }
};

GLIDAR_INLINE CellRect whole_sector(const GridView& grid) {
  return {0, static_cast<std::int32_t>(grid.columns) - 1, 0,
          static_cast<std::int32_t>(grid.rows) - 1};
}

/// Bounds of eight objects as seen from a sector: side / forward and up / forward.
struct Slopes {
  Float8 side_low;
  Float8 side_high;
  Float8 up_low;
  Float8 up_high;
};

/// Added before truncation: the result is at most the ceiling.
inline constexpr float kCeiling = 0.9999F;

/// Rectangles of cells for eight objects, before rounding to whole columns.
struct CellRects {
  alignas(32) float first[8];  ///< columns
  alignas(32) float last[8];
  alignas(32) float first_up[8];  ///< bins of elevations, or rows
  alignas(32) float last_up[8];

  /// Columns that may see object i, with these bounds of the beams' deviations.
  GLIDAR_INLINE void cut(const GridView& grid, unsigned i, float low_deviation,
                         float high_deviation, CellRect& rect) const {
    const auto end = static_cast<std::int32_t>(grid.columns) - 1;
    const auto low = static_cast<std::int32_t>(first[i] - high_deviation + kCeiling);
    const float high = last[i] - low_deviation;
    const std::int32_t whole = high < 0.0F ? -1 : static_cast<std::int32_t>(high);
    rect.first_column = low < 0 ? 0 : low;
    rect.last_column = whole > end ? end : whole;
  }

  /// All rows and columns that may see object i. Cells: AngleCells or SlopeCells.
  template <class Cells>
  [[nodiscard]] GLIDAR_INLINE CellRect at(const GridView& grid, unsigned i) const {
    CellRect rect;
    cut(grid, i, grid.min_deviation, grid.max_deviation, rect);
    Cells::cut_rows(grid, first_up[i], last_up[i], rect);
    return rect;
  }
};

GLIDAR_INLINE Float8 clamp(Float8 x, float low, float high) {
  return max(min(x, Float8::all(high)), Float8::all(low));
}

/// Within 1e-5 for |x| <= 1: M. Abramowitz, I. Stegun, "Handbook of Mathematical
/// Functions", 4.4.49.
GLIDAR_INLINE Float8 arc_tangent(Float8 x) {
  const Float8 y = x * x;
  Float8 p = multiply_add(y, Float8::all(0.0208351F), Float8::all(-0.0851330F));
  p = multiply_add(p, y, Float8::all(0.1801410F));
  p = multiply_add(p, y, Float8::all(-0.3302995F));
  return x * multiply_add(p, y, Float8::all(0.9998660F));
}

/// Bounds of the cosine 1 / sqrt(1 + x^2) of the azimuth with tangent x, |x| < 1. The Taylor series
/// alternates, so an even number of terms gives a lower bound and an odd number an upper bound.
GLIDAR_INLINE Float8 cosine_series(Float8 y, Float8 last) {
  Float8 p = multiply_add(last, y, Float8::all(-0.3125F));
  p = multiply_add(p, y, Float8::all(0.375F));
  p = multiply_add(p, y, Float8::all(-0.5F));
  return multiply_add(p, y, Float8::all(1.0F));
}
GLIDAR_INLINE Float8 low_cosine(Float8 x) {
  const Float8 y = x * x;
  return cosine_series(y, multiply_add(y, Float8::all(-0.2460938F), Float8::all(0.2734375F)));
}
GLIDAR_INLINE Float8 high_cosine(Float8 x) {
  return cosine_series(x * x, Float8::all(0.2734375F));
}

/// Columns of equal azimuth and rows of equal elevation.
struct AngleCells {
  /// Slopes are in the sector's own frame.
  static constexpr bool kUsesRotation = true;

  /// Finds cells from slopes. Returns a bit for each object that the sector may see.
  GLIDAR_INLINE static std::uint32_t find(const GridView& grid, const Slopes& s, CellRects& rects) {
    const float limit = grid.max_slope;
    auto meets = (s.side_low <= Float8::all(limit)) & (Float8::all(-limit) <= s.side_high);
    const Float8 low = clamp(s.side_low, -limit, limit);
    const Float8 high = clamp(s.side_high, -limit, limit);
    const Float8 scale = Float8::all(grid.columns_per_unit);
    const Float8 first = Float8::all(grid.middle_column - grid.column_margin);
    const Float8 last = Float8::all(grid.middle_column + grid.column_margin);
    store(rects.first, multiply_add(arc_tangent(low), scale, first));
    store(rects.last, multiply_add(arc_tangent(high), scale, last));
    // The tangent of the elevation is up / forward times the cosine of the azimuth.
    const Float8 zero = Float8::all(0.0F);
    const Float8 widest = max(magnitude(low), magnitude(high));
    const Float8 narrowest = max(max(low, -high), zero);
    const Float8 low_cos = low_cosine(widest);
    const Float8 high_cos = high_cosine(narrowest);
    const Float8 bottom = min(s.up_low * low_cos, s.up_low * high_cos);
    const Float8 top = max(s.up_high * low_cos, s.up_high * high_cos);
    const ElevationRows& rows = grid.elevations;
    meets = meets & (bottom <= Float8::all(rows.highest_tangent)) &
            (Float8::all(rows.lowest_tangent) <= top);
    const Float8 bins = Float8::all(rows.bins_per_tangent);
    const Float8 offset = Float8::all(-rows.lowest_tangent * rows.bins_per_tangent);
    const auto end = static_cast<float>(kElevationBins);
    store(rects.first_up, clamp(multiply_add(bottom, bins, offset), 0.0F, end));
    store(rects.last_up, clamp(multiply_add(top, bins, offset), 0.0F, end));
    return bits(meets);
  }

  /// Converts bins to rows.
  GLIDAR_INLINE static void cut_rows(const GridView& grid, float first, float last,
                                     CellRect& rect) {
    rect.first_row = grid.elevations.first_row[static_cast<std::int32_t>(first)];
    rect.last_row = grid.elevations.last_row[static_cast<std::int32_t>(last)];
  }
};

/// Columns and rows of equal slopes.
struct SlopeCells {
  static constexpr bool kUsesRotation = false;

  /// As AngleCells::find().
  GLIDAR_INLINE static std::uint32_t find(const GridView& grid, const Slopes& s, CellRects& rects) {
    const float limit = grid.max_slope;
    const auto meets = (s.side_low <= Float8::all(limit)) & (Float8::all(-limit) <= s.side_high) &
                       (s.up_low <= Float8::all(grid.highest_slope)) &
                       (Float8::all(grid.lowest_slope) <= s.up_high);
    const Float8 columns = Float8::all(grid.columns_per_unit);
    store(rects.first, multiply_add(clamp(s.side_low, -limit, limit), columns,
                                    Float8::all(grid.middle_column - grid.column_margin)));
    store(rects.last, multiply_add(clamp(s.side_high, -limit, limit), columns,
                                   Float8::all(grid.middle_column + grid.column_margin)));
    const Float8 rows = Float8::all(grid.slopes.rows_per_slope);
    const Float8 bottom = clamp(s.up_low, grid.lowest_slope, grid.highest_slope);
    const Float8 top = clamp(s.up_high, grid.lowest_slope, grid.highest_slope);
    store(rects.first_up, multiply_add(bottom, rows, Float8::all(grid.slopes.first_row)));
    store(rects.last_up, multiply_add(top, rows, Float8::all(grid.slopes.last_row)));
    return bits(meets);
  }

  /// Rounds to whole rows.
  GLIDAR_INLINE static void cut_rows(const GridView& grid, float first, float last,
                                     CellRect& rect) {
    const auto end = static_cast<std::int32_t>(grid.rows) - 1;
    const auto low = static_cast<std::int32_t>(first + kCeiling);
    const std::int32_t high = last < 0.0F ? -1 : static_cast<std::int32_t>(last);
    rect.first_row = low < 0 ? 0 : low;
    rect.last_row = high > end ? end : high;
  }
};

/// Linear transform from an instance's frame into that of the sector, or of its slopes.
struct FrameTransform {
  Vector<Float8> forward;
  Vector<Float8> side;
  Vector<Float8> up;

  GLIDAR_INLINE explicit FrameTransform(const float (&m)[3][3])
      : forward(row(m[0])), side(row(m[1])), up(row(m[2])) {}

  GLIDAR_INLINE static Vector<Float8> row(const float (&r)[3]) {
    return {Float8::all(r[0]), Float8::all(r[1]), Float8::all(r[2])};
  }
  /// The sector's x, y and z are forward, side and up.
  [[nodiscard]] GLIDAR_INLINE Vector<Float8> operator()(const Vector<Float8>& v) const {
    return {dot(forward, v), dot(side, v), dot(up, v)};
  }
};

}  // namespace glidar::rays::GLIDAR_KERNEL
