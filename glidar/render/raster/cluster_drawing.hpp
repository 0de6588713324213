// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/grid_window.hpp>
#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/raster/tile_buffer.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/triangle_ids.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glidar::raster {

/// Projects the corners of one cluster into one tile in single precision. Corners are relative to
/// the cluster's middle and pixels to the tile, so no large numbers occur.
struct TileTransform {
  std::array<float, 9> matrix;  ///< column by column: to (column, row, 1) times depth
  float column, row, depth;     ///< of the middle, the first two times its depth
  float before_far;             ///< from the middle to the far plane, m
  float factor;                 ///< Nearness::factor
  float min_depth;              ///< of corners in single precision
  float last_col, last_row;     ///< of the tile
  bool cull_back_faces;
};

/// Edges are moved outwards by this many pixels: more than rounding moves them, so that no beam
/// falls between two triangles. Pixels that are covered by mistake are re-tested exactly.
inline constexpr float kEdgeMargin_px = 0x1p-13F;

/// How a triangle is drawn.
enum class SizeClass : std::int32_t {
  none,   ///< it covers no pixel of the tile
  small,  ///< within kSmall x kSmall pixels
  medium,
  large  ///< set up in double precision; it may cover no pixel
};

inline constexpr int kSmall = 4;

/// Setups of the triangles of a packet, lane by lane; see TriangleSetup.
struct TriangleSetups {
  std::array<Lanes<float>, 3> per_col;
  std::array<Lanes<float>, 3> per_row;
  std::array<Lanes<float>, 3> at_corner;
  std::array<Lanes<float>, 3> certain;
  Lanes<float> nearness_per_col;
  Lanes<float> nearness_per_row;
  Lanes<float> nearness_at_corner;
  Lanes<float> farthest;
  Lanes<float> nearest;
  Lanes<float> margin;
  Lanes<std::int32_t> left;
  Lanes<std::int32_t> right;
  Lanes<std::int32_t> top;
  Lanes<std::int32_t> bottom;
  Lanes<std::int32_t> size;  ///< a SizeClass

  /// The setup of one triangle, whose size class is not `large`.
  [[nodiscard]] TriangleSetup setup(unsigned lane, std::uint32_t triangle_id) const;
};

void set_up_triangles(const TileTransform& transform, const CornerBlock& corners,
                      TriangleSetups& footprints);

/// Coverage masks of small triangles: bit kSmall * row + column of the rectangle for each covered
/// pixel, and kCertainShift bits higher where that is certain. Returns a bit for every lane that
/// has something to draw.
inline constexpr int kCertainShift = kSmall * kSmall;
std::uint32_t coverage_masks(const TriangleSetups& footprints, Lanes<std::uint32_t>& coverage);

/// Sets up any triangle in double from its corners as (column, row, 1) times depth in the tile;
/// none when it covers nothing there. Corners may be behind the sensor: M. Olano and T. Greer,
/// "Triangle scan conversion using 2D homogeneous coordinates" (1997).
std::optional<TriangleSetup> set_up_triangle(const Eigen::Matrix3d& corners,
                                             const Nearness& nearness, const PixelBounds& tile,
                                             bool cull_back_faces);

/// Inputs that all tiles of a cast share.
struct DrawContext {
  const CastRequest& request;
  const Resolver& resolver;
  const std::vector<PackedMesh>& meshes;
  const std::vector<PixelView>& views;  ///< per instance
  const TriangleIds& triangles;
  const std::vector<std::uint8_t>& has_mask;  ///< per instance
  Nearness nearness;
};

/// Prefetches a cluster.
void prefetch(const DrawContext& context, const VisibleCluster& cluster);

/// A pixel of the image, or the position of a tile's first pixel in the image.
struct PixelPosition {
  std::int32_t col;
  std::int32_t row;
};

/// Draws one cluster into a tile that starts at the pixel `first` of the image.
void draw_cluster(const DrawContext& context, const VisibleCluster& cluster,
                  const PixelPosition& first, TileBuffer& buffer);

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
