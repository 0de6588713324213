// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/grid_window.hpp>
#include <glidar/render/raster/cluster_drawing.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::raster {

/// A tile of the image. One pixel more is drawn on each side than is written, because uncertain
/// beams use the pixels around them.
struct Tile {
  PixelRect drawn;
  PixelRect written;
};

/// The tiles of the visible part of an image, and the clusters in each. They depend on the image
/// alone, not on threads.
class TileGrid {
 public:
  /// Divides the window, which is not empty, of an image of this size.
  void build(const GridWindow& window, std::uint32_t rows, std::uint32_t cols);

  /// Lists the clusters of each tile.
  void bin_clusters(std::span<const VisibleCluster> clusters);

  [[nodiscard]] std::size_t size() const { return std::size_t{across_} * down_; }
  [[nodiscard]] Tile tile(std::size_t index) const;

  /// Indices of the clusters in the tile.
  [[nodiscard]] std::span<const std::uint32_t> clusters_in(std::size_t index) const {
    return {cluster_indices_.data() + first_[index], first_[index + 1] - first_[index]};
  }

 private:
  template <class Body>
  void for_tiles_of(const VisibleCluster& cluster, const Body& body) const;

  GridWindow window_;
  std::uint32_t rows_ = 0;  ///< of the image
  std::uint32_t cols_ = 0;
  std::uint32_t width_ = 1;  ///< of a tile
  std::uint32_t height_ = 1;
  std::uint32_t across_ = 0;  ///< tiles
  std::uint32_t down_ = 0;
  std::vector<std::size_t> first_;              ///< per tile and one more, into cluster_indices_
  std::vector<std::uint32_t> cluster_indices_;  ///< clusters, tile by tile
};

}  // namespace glidar::raster
