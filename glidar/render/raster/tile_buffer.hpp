// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/lanes.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar::raster {

/// A rectangle of a canvas, both ends included.
struct PixelBounds {
  int left;
  int right;
  int top;
  int bottom;
};

/// A triangle on a canvas, ready to be drawn: three borders, each positive inside, and its
/// nearness, all linear in column and row.
struct TriangleSetup {
  std::array<float, 3> per_col;
  std::array<float, 3> per_row;
  std::array<float, 3> at_corner;  ///< at the left top pixel of the rectangle
  std::array<float, 3> certain;    ///< who is so far inside of a border is not beyond it
  float nearness_per_col;
  float nearness_per_row;
  float nearness_at_corner;
  float farthest;  ///< nearness is held between these
  float nearest;
  float margin;  ///< what interpolation may make nearness wrong by, see closeness()
  std::uint32_t triangle_id;
  PixelBounds rect;  ///< of the pixels it may cover
};

/// How far nearness may differ for a surface to be in doubt, of two that are not rough: 32
/// roundings of the nearness and of the depths that it comes from, `scale` being Nearness::factor,
/// and what interpolation adds. The beams there are cast, so it only has to be large enough.
[[gnu::always_inline]] inline float closeness(float nearness, float scale, float margin) {
  return 0x1p-19F * (nearness + scale) + margin;
}

/// True where interpolation adds much: then the beam is cast in any case.
[[gnu::always_inline]] inline bool is_rough(float nearness, float scale, float margin) {
  return margin > 0x1p-21F * (nearness + scale);
}

/// A part of a picture while it is drawn: per pixel the nearest triangle's number. Where another
/// triangle is too close to decide which is nearer, or where interpolation is rough, the number has
/// kContestedFlag set, also when something nearer was drawn over both later. What is drawn does not
/// depend on the order in which it comes: of two that are equally near the lower number stays.
/// Pixels lie in memory in blocks of 4x4.
class TileBuffer {
 public:
  static constexpr int kSide = 128;  ///< most columns and rows

  /// Makes it empty, of this size; scale: Nearness::factor of what will be drawn.
  void clear(int cols, int rows, float scale);

  [[nodiscard]] int cols() const { return cols_; }
  [[nodiscard]] int rows() const { return rows_; }

  /// True when everything in the rectangle is clearly nearer already than `at_most`.
  [[nodiscard]] bool is_occluded(const PixelBounds& rect, float max_nearness);

  /// To be called when something was drawn there.
  void mark_stale(const PixelBounds& rect);

  /// Draws one pixel if it is nearer than what is there. The number may have kCertainFlag set;
  /// `room` is that of a shape.
  void depth_test(int col, int row, float nearness, float margin, std::uint32_t triangle_id) {
    const std::size_t at = centroid(col, row);
    const float before = nearness_[at];
    const float close = closeness(nearness, scale_, margin);
    if (nearness < before - close) return;
    const std::uint32_t old = triangle_ids_[at];
    const bool draws = nearness > before || (nearness == before && (triangle_id & kTriangleIdMask) <
                                                                       (old & kTriangleIdMask));
    const bool is_contested =
        nearness <= before + close || (draws && is_rough(nearness, scale_, margin));
    const std::uint32_t contested = (old & kContestedFlag) | (is_contested ? kContestedFlag : 0);
    nearness_[at] = draws ? nearness : before;
    triangle_ids_[at] = (draws ? triangle_id : old) | contested;
  }

  /// Draws all pixels of a shape, and perhaps some in the blocks around its rectangle.
  void draw(const TriangleSetup& setup);

  /// Writes the numbers row by row.
  void copy_triangle_ids(std::vector<std::uint32_t>& triangle_ids) const;

 private:
  static constexpr std::size_t kBlock = 4;
  static constexpr std::size_t kBlocks = kSide / kBlock;  ///< in a row of blocks
  static constexpr int kCell = 8;                         ///< pixels along a side of a cell
  static constexpr int kCells = kSide / kCell;            ///< in a row of cells
  static constexpr std::size_t kPixels = std::size_t{kSide} * kSide;

  static std::size_t centroid(int col, int row) {
    const auto c = static_cast<std::size_t>(col);
    const auto r = static_cast<std::size_t>(row);
    const std::size_t block = r / kBlock * kBlocks + c / kBlock;
    return block * kLanes + r % kBlock * kBlock + c % kBlock;
  }
  static std::size_t cell_at(int cell_col, int cell_row) {
    return static_cast<std::size_t>(cell_row) * kCells + static_cast<std::size_t>(cell_col);
  }
  [[nodiscard]] float min_nearness_in(int cell_col, int cell_row);
  [[nodiscard]] float min_nearness_of(int cell_col, int cell_row) const;
  [[nodiscard]] bool are_pixels_occluded(const PixelBounds& rect, float nearness) const;

  int cols_ = 0;
  int rows_ = 0;
  float scale_ = 1.0F;
  alignas(64) std::array<float, kPixels> nearness_;  ///< of what is drawn; below all: nothing
  alignas(64) std::array<std::uint32_t, kPixels> triangle_ids_;
  std::array<float, std::size_t{kCells} * kCells> min_nearness_;  ///< per cell, of its pixels
  std::array<bool, std::size_t{kCells} * kCells>
      is_stale_;  ///< min_nearness_ there is to be found anew
};

}  // namespace glidar::raster
