// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/raster/packed_mesh.hpp>
#include <glidar/render/raster/tile_buffer.hpp>
#include <glidar/render/raster/visible_clusters.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace glidar::raster {

/// How one cluster's corners come onto one canvas, in single precision: the large numbers are gone,
/// as corners are relative to the cluster's middle and pixels to the canvas.
struct TileTransform {
  std::array<float, 9> matrix;        ///< column by column: to (column, row, 1) times depth
  float column_at_depth, row, depth;  ///< of the middle, the first two times its depth
  float before_far;                   ///< from the middle to the far plane, m
  float factor;                       ///< Nearness::factor
  float min_depth;                    ///< of corners that single precision suits
  float last_col, last_row;           ///< of the canvas
  bool cull_back_faces;
};

/// Borders are drawn this far outside of where they are, pixels: more than rounding moves them, so
/// that no beam falls between two triangles. Who gets one falsely is found out afterwards.
inline constexpr float kEdgeMargin_px = 0x1p-13F;

/// What there is to do about a triangle.
enum class SizeClass : std::int32_t {
  none,   ///< it covers no pixel of the canvas
  small,  ///< it covers some of kSmall x kSmall pixels
  medium,
  large  ///< for double precision, perhaps of no pixel
};

inline constexpr int kSmall = 4;

/// The triangles of a pack on a canvas, see Shape.
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
  Lanes<std::int32_t> size;  ///< a Size

  /// One of the triangles; of a size other than large.
  [[nodiscard]] TriangleSetup setup(unsigned lane, std::uint32_t triangle_id) const;
};

void set_up_triangles(const TileTransform& transform, const CornerBlock& corners,
                      TriangleSetups& footprints);

/// Per small triangle, bits for pixels of its rectangle: bit kSmall * row + column where it covers
/// one, and kCertainShift bits further up where that is certain. Returns a bit for every lane where
/// there is something to draw.
inline constexpr int kCertainShift = kSmall * kSmall;
std::uint32_t coverage_masks(const TriangleSetups& footprints, Lanes<std::uint32_t>& coverage);

/// The shape of any triangle, worked out in double from its corners as (column, row, 1) times depth
/// on the canvas; none when it covers nothing there. Corners behind the sensor are welcome: M.
/// Olano and T. Greer, "Triangle scan conversion using 2D homogeneous coordinates" (1997).
std::optional<TriangleSetup> set_up_triangle(const Eigen::Matrix3d& corners,
                                             const Nearness& nearness, const PixelBounds& tile,
                                             bool cull_back_faces);

}  // namespace glidar::raster
