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

/// A rectangle of a tile, both ends included.
struct PixelBounds {
  int left;
  int right;
  int top;
  int bottom;
};

/// Triangle setup: three edge functions, positive inside, and nearness, all linear in column and
/// row of the tile.
struct TriangleSetup {
  std::array<float, 3> per_col;
  std::array<float, 3> per_row;
  std::array<float, 3> at_corner;  ///< at the top left pixel of the rectangle
  std::array<float, 3> certain;    ///< from these values on, a pixel is certainly inside
  float nearness_per_col;
  float nearness_per_row;
  float nearness_at_corner;
  float farthest;  ///< nearness is clamped to these
  float nearest;
  float margin;  ///< error bound of interpolated nearness, see closeness()
  std::uint32_t triangle_id;
  PixelBounds rect;  ///< of the pixels it may cover
};

/// How close the nearness of two surfaces may be for the nearer one to be uncertain: 32 roundings
/// of the nearness and of the depths behind it (`scale`: Nearness::factor), and the interpolation
/// error. These beams are cast, so any upper bound is correct.
[[gnu::always_inline]] inline float closeness(float nearness, float scale, float margin) {
  return 0x1p-19F * (nearness + scale) + margin;
}

/// True where the interpolation error is large: then the beam is cast in any case.
[[gnu::always_inline]] inline bool is_rough(float nearness, float scale, float margin) {
  return margin > 0x1p-21F * (nearness + scale);
}

/// The visibility buffer of a tile while it is drawn: the nearest triangle's id per pixel. Where
/// another triangle is too close to decide which is nearer, or where interpolation is rough, the id
/// has kContestedFlag set, also when both are occluded later. The result does not depend on the
/// drawing order: of two equally near triangles the one with the lower id stays. Pixels are stored
/// in blocks of 4x4.
class TileBuffer {
 public:
  static constexpr int kSide = 128;  ///< maximum number of columns and rows

  /// Resizes and clears it; scale: Nearness::factor of the triangles to come.
  void clear(int cols, int rows, float scale);

  [[nodiscard]] int cols() const { return cols_; }
  [[nodiscard]] int rows() const { return rows_; }

  /// True when everything in the rectangle is already clearly nearer than `max_nearness`.
  [[nodiscard]] bool is_occluded(const PixelBounds& rect, float max_nearness);

  /// Must be called after drawing in the rectangle.
  void mark_stale(const PixelBounds& rect);

  /// Draws one pixel if it passes the depth test. The id may have kCertainFlag set; `margin`: see
  /// TriangleSetup.
  void depth_test(int col, int row, float nearness, float margin, std::uint32_t triangle_id) {
    const std::size_t at = index_of(col, row);
    const float previous = nearness_[at];
    const float close = closeness(nearness, scale_, margin);
    if (nearness < previous - close) return;
    const std::uint32_t old = triangle_ids_[at];
    const bool draws =
        nearness > previous ||
        (nearness == previous && (triangle_id & kTriangleIdMask) < (old & kTriangleIdMask));
    const bool is_contested =
        nearness <= previous + close || (draws && is_rough(nearness, scale_, margin));
    const std::uint32_t contested = (old & kContestedFlag) | (is_contested ? kContestedFlag : 0);
    nearness_[at] = draws ? nearness : previous;
    triangle_ids_[at] = (draws ? triangle_id : old) | contested;
  }

  /// Draws all pixels of a triangle, and perhaps some in the blocks around its rectangle.
  void draw(const TriangleSetup& setup);

  /// Writes the ids row by row.
  void copy_triangle_ids(std::vector<std::uint32_t>& triangle_ids) const;

 private:
  static constexpr std::size_t kBlock = 4;
  static constexpr std::size_t kBlocks = kSide / kBlock;  ///< in a row of blocks
  static constexpr int kCell = 8;                         ///< pixels along a side of a cell
  static constexpr int kCells = kSide / kCell;            ///< in a row of cells
  static constexpr std::size_t kPixels = std::size_t{kSide} * kSide;

  static std::size_t index_of(int col, int row) {
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
  alignas(64) std::array<float, kPixels> nearness_;  ///< kEmptyNearness where nothing is drawn
  alignas(64) std::array<std::uint32_t, kPixels> triangle_ids_;
  std::array<float, std::size_t{kCells} * kCells> min_nearness_;  ///< per cell, of its pixels
  std::array<bool, std::size_t{kCells} * kCells> is_stale_;  ///< min_nearness_ must be recomputed
};

}  // namespace glidar::raster
