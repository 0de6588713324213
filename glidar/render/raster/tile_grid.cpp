// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/tile_grid.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glidar::raster {
namespace {

// Enough tiles for balanced threads; with smaller ones, many clusters would be in several tiles.
constexpr double kTargetTiles = 24.0;
constexpr double kMinSide = 24.0;
constexpr double kMaxSide =
    112.0;  // a multiple of kLanes, with the margin within TileBuffer::kSide

std::uint32_t pieces(std::uint32_t length, double side) {
  return static_cast<std::uint32_t>(std::ceil(length / side));
}

/// Pixels [first - 1, end + 1), within [0, all).
void widen(std::uint32_t& first, std::uint32_t& count, std::uint32_t all) {
  const std::uint32_t end = std::min(first + count + 1, all);
  first = first == 0 ? 0 : first - 1;
  count = end - first;
}

}  // namespace

void TileGrid::build(const GridWindow& window, std::uint32_t rows, std::uint32_t cols) {
  rows_ = rows;
  cols_ = cols;
  window_ = {window.first_row, std::min(window.end_row, rows), window.first_col,
             std::min(window.end_col, cols)};
  const std::uint32_t height = window_.end_row - window_.first_row;
  const std::uint32_t width = window_.end_col - window_.first_col;
  const double side =
      std::clamp(std::sqrt(double{1.0} * height * width / kTargetTiles), kMinSide, kMaxSide);
  down_ = pieces(height, side);
  across_ = pieces(width, side);
  height_ = (height + down_ - 1) / down_;
  // Hits are written in blocks of kLanes pixels.
  width_ = ((width + across_ - 1) / across_ + kLanes - 1) / kLanes * kLanes;
  down_ = (height + height_ - 1) / height_;
  across_ = (width + width_ - 1) / width_;
}

Tile TileGrid::tile(std::size_t index) const {
  const auto down = static_cast<std::uint32_t>(index / across_);
  const auto across = static_cast<std::uint32_t>(index % across_);
  Tile tile{};
  tile.written.first_row = window_.first_row + down * height_;
  tile.written.first_col = window_.first_col + across * width_;
  tile.written.rows = std::min(height_, window_.end_row - tile.written.first_row);
  tile.written.cols = std::min(width_, window_.end_col - tile.written.first_col);
  tile.drawn = tile.written;
  widen(tile.drawn.first_row, tile.drawn.rows, rows_);
  widen(tile.drawn.first_col, tile.drawn.cols, cols_);
  return tile;
}

/// Calls body(tile) for the tiles whose drawn pixels overlap the cluster.
template <class Body>
void TileGrid::for_tiles_of(const VisibleCluster& cluster, const Body& body) const {
  const auto tile_index = [](std::int64_t pixel, std::uint32_t first, std::uint32_t side,
                             std::uint32_t count) {
    const std::int64_t at = std::max<std::int64_t>(pixel - first, 0) / side;
    return static_cast<std::uint32_t>(std::min<std::int64_t>(at, count - 1));
  };
  const std::uint32_t first_col =
      tile_index(std::int64_t{cluster.left} - 1, window_.first_col, width_, across_);
  const std::uint32_t last_col =
      tile_index(std::int64_t{cluster.right} + 1, window_.first_col, width_, across_);
  const std::uint32_t first_row =
      tile_index(std::int64_t{cluster.top} - 1, window_.first_row, height_, down_);
  const std::uint32_t last_row =
      tile_index(std::int64_t{cluster.bottom} + 1, window_.first_row, height_, down_);
  for (std::uint32_t row = first_row; row <= last_row; ++row) {
    for (std::uint32_t col = first_col; col <= last_col; ++col) {
      body(std::size_t{row} * across_ + col);
    }
  }
}

void TileGrid::bin_clusters(std::span<const VisibleCluster> clusters) {
  first_.assign(size() + 2, 0);  // shifted by one while the tiles are filled
  for (const VisibleCluster& cluster : clusters) {
    for_tiles_of(cluster, [&](std::size_t tile) { ++first_[tile + 2]; });
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  cluster_indices_.resize(first_.back());
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    for_tiles_of(clusters[i], [&](std::size_t tile) { cluster_indices_[first_[tile + 1]++] = i; });
  }
  first_.pop_back();
}

}  // namespace glidar::raster
