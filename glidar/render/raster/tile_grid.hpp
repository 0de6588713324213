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

/// A part of a picture that fits a canvas. A pixel more is drawn on each side than is written: a
/// beam in doubt looks at the pixels around it.
struct Tile {
  PixelRect drawn;
  PixelRect written;
};

/// The part of a picture that is of interest, cut into parts, and the clusters seen in each. It
/// depends on the picture alone and not on who draws it.
class TileGrid {
 public:
  /// Cuts the window, which is not empty, out of a picture of so many rows and columns.
  void build(const GridWindow& window, std::uint32_t rows, std::uint32_t cols);

  /// Shares the clusters out among the parts.
  void bin_clusters(std::span<const VisibleCluster> clusters);

  [[nodiscard]] std::size_t size() const { return std::size_t{across_} * down_; }
  [[nodiscard]] Tile tile(std::size_t index) const;

  /// Which of the clusters the part sees.
  [[nodiscard]] std::span<const std::uint32_t> clusters_in(std::size_t index) const {
    return {seen_.data() + first_[index], first_[index + 1] - first_[index]};
  }

 private:
  template <class Body>
  void for_tiles_of(const VisibleCluster& cluster, const Body& body) const;

  GridWindow window_;
  std::uint32_t rows_ = 0;  ///< of the picture
  std::uint32_t cols_ = 0;
  std::uint32_t width_ = 1;  ///< of a part
  std::uint32_t height_ = 1;
  std::uint32_t across_ = 0;  ///< parts
  std::uint32_t down_ = 0;
  std::vector<std::size_t> first_;   ///< per part and one more, into seen_
  std::vector<std::uint32_t> seen_;  ///< clusters, part by part
};

}  // namespace glidar::raster
