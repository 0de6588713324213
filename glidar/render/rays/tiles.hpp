// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/render/grid_window.hpp>
#include <glidar/render/lanes.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace glidar::rays {

/// A small rectangle of the beam grid: its beams are cast together, one per lane, row by row.
struct Tile {
  static constexpr std::size_t kOutside = std::numeric_limits<std::size_t>::max();
  std::uint32_t first_row;
  std::uint32_t first_col;
  std::uint32_t width_shift;  ///< log2 of the tile's width
  std::uint32_t rows;         ///< of the whole grid
  std::uint32_t cols;

  [[nodiscard]] bool is_whole(std::uint32_t lanes) const {
    return first_row + (lanes >> width_shift) <= rows && first_col + (1U << width_shift) <= cols;
  }

  [[nodiscard]] GridWindow window(std::uint32_t lanes) const {
    return {first_row, first_row + (lanes >> width_shift), first_col,
            first_col + (1U << width_shift)};
  }

  /// Index of a lane's beam, or kOutside beyond the grid's border.
  [[nodiscard]] std::size_t beam(std::uint32_t lane) const {
    const std::uint32_t row = first_row + (lane >> width_shift);
    const std::uint32_t col = first_col + (lane & ((1U << width_shift) - 1U));
    return row < rows && col < cols ? std::size_t{row} * cols + col : kOutside;
  }
};

/// The beam grid divided into tiles of kLanes beams: 4x4, flatter where the grid has fewer rows.
class Tiling {
 public:
  explicit Tiling(const Beams& beams) : rows_(beams.rows), cols_(beams.cols) {
    while (height_ > 1 && height_ > rows_) height_ /= 2;
    while ((height_ << width_shift_) < kLanes) ++width_shift_;
    tile_cols_ = std::max<std::uint32_t>(1, (cols_ + (1U << width_shift_) - 1U) >> width_shift_);
    tile_rows_ = (rows_ + height_ - 1U) / height_;
  }

  [[nodiscard]] std::size_t size() const { return std::size_t{tile_rows_} * tile_cols_; }

  /// True if the beams of a tile follow each other: the grid has one row.
  [[nodiscard]] bool has_runs() const { return (1U << width_shift_) == kLanes; }

  [[nodiscard]] Tile tile(std::size_t index) const {
    const auto row = static_cast<std::uint32_t>(index / tile_cols_);
    const auto col = static_cast<std::uint32_t>(index % tile_cols_);
    return {row * height_, col << width_shift_, width_shift_, rows_, cols_};
  }

  /// End of the tiles from `begin` on in one row of tiles: at most `max_count`, and before `end`.
  [[nodiscard]] std::size_t end_of_run(std::size_t begin, std::size_t end,
                                       std::size_t max_count) const {
    const std::size_t end_of_row = (begin / tile_cols_ + 1) * tile_cols_;
    return std::min({end, begin + max_count, end_of_row});
  }

  /// Calls body(BeamRange) for each row of beams in tiles [begin, end) of one row of tiles.
  template <class Body>
  void for_beam_rows(std::size_t begin, std::size_t end, const Body& body) const {
    const Tile first = tile(begin);
    const Tile last = tile(end - 1);
    const std::uint32_t end_col = std::min(cols_, last.first_col + (1U << width_shift_));
    const std::uint32_t end_row = std::min(rows_, first.first_row + height_);
    for (std::uint32_t row = first.first_row; row < end_row; ++row) {
      const std::size_t start = std::size_t{row} * cols_;
      body(BeamRange{start + first.first_col, start + end_col});
    }
  }

 private:
  std::uint32_t rows_;
  std::uint32_t cols_;
  std::uint32_t height_ = 4;
  std::uint32_t width_shift_ = 0;
  std::uint32_t tile_rows_ = 0;
  std::uint32_t tile_cols_ = 0;
};

}  // namespace glidar::rays
