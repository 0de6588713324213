// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/cluster_drawing.hpp>

#include <glidar/math/simd.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

namespace glidar::raster {
namespace {

// Columns and rows of corners in this range are accurate enough in single precision.
constexpr float kMin_px = -64.0F;
constexpr float kMax_px = 192.0F;

// Eight roundings of each term of an interpolation.
constexpr float kInterpolation = 0x1p-21F;

/// One corner of each triangle, projected into the tile.
struct CornerProjection {
  Lanes<float> col;
  Lanes<float> row;
  Lanes<float> nearness;
  Lanes<float> depth;
};

[[gnu::always_inline]] inline void project_corners(const TileTransform& transform,
                                                   const Lanes3<float>& corner,
                                                   CornerProjection& projection) {
  const float* m = transform.matrix.data();
  for (unsigned i = 0; i < kLanes; ++i) {
    const float x = corner.x[i];
    const float y = corner.y[i];
    const float z = corner.z[i];
    const float deeper = m[2] * x + m[5] * y + m[8] * z;
    const float depth = transform.depth + deeper;
    const float inverse = 1.0F / depth;
    projection.col[i] = (transform.column + (m[0] * x + m[3] * y + m[6] * z)) * inverse;
    projection.row[i] = (transform.row + (m[1] * x + m[4] * y + m[7] * z)) * inverse;
    projection.nearness[i] = (transform.before_far - deeper) * transform.factor * inverse;
    projection.depth[i] = depth;
  }
}

[[gnu::always_inline]] inline float size_of(float value) {
  return value < 0.0F ? -value : value;
}
[[gnu::always_inline]] inline float min3(float a, float b, float c) {
  const float ab = a < b ? a : b;
  return ab < c ? ab : c;
}
[[gnu::always_inline]] inline float max3(float a, float b, float c) {
  const float ab = a > b ? a : b;
  return ab > c ? ab : c;
}
[[gnu::always_inline]] inline float clamped(float value, float low, float high) {
  const float above = value > low ? value : low;  // low for NaN
  return above < high ? above : high;
}
[[gnu::always_inline]] inline std::int32_t rounded_up(float value) {
  const auto whole = static_cast<std::int32_t>(value);
  return whole + static_cast<std::int32_t>(static_cast<float>(whole) < value);
}
[[gnu::always_inline]] inline std::int32_t rounded_down(float value) {
  const auto whole = static_cast<std::int32_t>(value);
  return whole - static_cast<std::int32_t>(static_cast<float>(whole) > value);
}

[[gnu::always_inline]] inline std::int32_t largest(const Lanes<std::int32_t>& values) {
  std::int32_t maximum = values[0];
  for (unsigned i = 0; i < kLanes; ++i) maximum = values[i] > maximum ? values[i] : maximum;
  return maximum;
}

/// Finds pixel bounds and size classes.
[[gnu::always_inline]] inline void bound(const TileTransform& transform,
                                         const std::array<CornerProjection, 3>& projections,
                                         TriangleSetups& f) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float left = min3(projections[0].col[i], projections[1].col[i], projections[2].col[i]);
    const float right = max3(projections[0].col[i], projections[1].col[i], projections[2].col[i]);
    const float top = min3(projections[0].row[i], projections[1].row[i], projections[2].row[i]);
    const float bottom = max3(projections[0].row[i], projections[1].row[i], projections[2].row[i]);
    const float depth =
        min3(projections[0].depth[i], projections[1].depth[i], projections[2].depth[i]);
    f.left[i] = rounded_up(clamped(left - kEdgeMargin_px, 0.0F, transform.last_col + 1.0F));
    f.right[i] = rounded_down(clamped(right + kEdgeMargin_px, -1.0F, transform.last_col));
    f.top[i] = rounded_up(clamped(top - kEdgeMargin_px, 0.0F, transform.last_row + 1.0F));
    f.bottom[i] = rounded_down(clamped(bottom + kEdgeMargin_px, -1.0F, transform.last_row));
    const int is_clear = static_cast<int>(depth > transform.min_depth);
    const int is_near = static_cast<int>(left > kMin_px) & static_cast<int>(right < kMax_px) &
                        static_cast<int>(top > kMin_px) & static_cast<int>(bottom < kMax_px);
    const int is_empty =
        static_cast<int>(f.left[i] > f.right[i]) | static_cast<int>(f.top[i] > f.bottom[i]);
    const int is_small = static_cast<int>(f.right[i] - f.left[i] < kSmall) &
                         static_cast<int>(f.bottom[i] - f.top[i] < kSmall);
    // As integers, so that the loop vectorises: small 1, medium 2, large 3.
    const int fitting = 2 - is_small;
    f.size[i] = (is_clear & is_empty) != 0 ? 0 : ((is_clear & is_near) != 0 ? fitting : 3);
  }
}

/// The edge function from corner a to b of all triangles, positive on the side of `sign`.
[[gnu::always_inline]] inline void find_edge(const CornerProjection& a, const CornerProjection& b,
                                             const Lanes<float>& sign, std::size_t k,
                                             TriangleSetups& f) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float per_col = sign[i] * (a.row[i] - b.row[i]);
    const float per_row = sign[i] * (b.col[i] - a.col[i]);
    const float width =
        (per_col < 0.0F ? -per_col : per_col) + (per_row < 0.0F ? -per_row : per_row);
    f.per_col[k][i] = per_col;
    f.per_row[k][i] = per_row;
    f.at_corner[k][i] = per_col * (static_cast<float>(f.left[i]) - a.col[i]) +
                        per_row * (static_cast<float>(f.top[i]) - a.row[i]) +
                        kEdgeMargin_px * width;
    f.certain[k][i] = 2.0F * kEdgeMargin_px * width;
  }
}

/// Finds signs of areas and nearness; triangles that are degenerate or culled are dropped.
[[gnu::always_inline]] inline void find_nearness(const TileTransform& transform,
                                                 const std::array<CornerProjection, 3>& projections,
                                                 Lanes<float>& sign, TriangleSetups& f) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float col = projections[0].col[i];
    const float row = projections[0].row[i];
    const float near = projections[0].nearness[i];
    const float col_1 = projections[1].col[i] - col;
    const float row_1 = projections[1].row[i] - row;
    const float near_1 = projections[1].nearness[i] - near;
    const float col_2 = projections[2].col[i] - col;
    const float row_2 = projections[2].row[i] - row;
    const float near_2 = projections[2].nearness[i] - near;
    const float area = col_1 * row_2 - col_2 * row_1;  // positive: seen from behind
    const float inverse = 1.0F / area;
    sign[i] = area < 0.0F ? -1.0F : 1.0F;
    f.nearness_per_col[i] = (near_1 * row_2 - near_2 * row_1) * inverse;
    f.nearness_per_row[i] = (near_2 * col_1 - near_1 * col_2) * inverse;
    f.nearness_at_corner[i] = near + f.nearness_per_col[i] * (static_cast<float>(f.left[i]) - col) +
                              f.nearness_per_row[i] * (static_cast<float>(f.top[i]) - row);
    f.farthest[i] = min3(near, projections[1].nearness[i], projections[2].nearness[i]);
    f.nearest[i] = max3(near, projections[1].nearness[i], projections[2].nearness[i]);
    // Sizes of the terms of the area and of the gradient: cancellation amplifies their rounding.
    const float area_terms = size_of(col_1 * row_2) + size_of(col_2 * row_1);
    const float across = size_of(near_1 * row_2) + size_of(near_2 * row_1);
    const float down = size_of(near_2 * col_1) + size_of(near_1 * col_2);
    const float farther_col =
        static_cast<float>(f.right[i] - f.left[i]) + size_of(static_cast<float>(f.left[i]) - col);
    const float farther_row =
        static_cast<float>(f.bottom[i] - f.top[i]) + size_of(static_cast<float>(f.top[i]) - row);
    const float steepness = (across * farther_col + down * farther_row) * size_of(inverse);
    const float margin = kInterpolation * (1.0F + area_terms * size_of(inverse)) * steepness;
    const float whole = f.nearest[i] - f.farthest[i];  // nearness is clamped to it
    f.margin[i] = margin < whole ? margin : whole;
    const int is_culled =
        static_cast<int>(transform.cull_back_faces) & static_cast<int>(area > 0.0F);
    const int is_gone = (is_culled | static_cast<int>(area == 0.0F)) &
                        static_cast<int>(f.size[i] != static_cast<int>(SizeClass::large));
    f.size[i] = is_gone != 0 ? 0 : f.size[i];
  }
}

/// Sizes of small triangles' rectangles; zero for all others.
struct SmallRects {
  Lanes<std::int32_t> cols;
  Lanes<std::int32_t> rows;
};

/// Tests one pixel of each small triangle's rectangle.
[[gnu::always_inline]] inline void test_pixel(const TriangleSetups& f, const SmallRects& rects,
                                              std::int32_t col, std::int32_t row,
                                              Lanes<std::uint32_t>& coverage) {
  const auto across = static_cast<float>(col);
  const auto down = static_cast<float>(row);
  const std::int32_t shift = kSmall * row + col;
  for (unsigned i = 0; i < kLanes; ++i) {
    const float b0 = f.at_corner[0][i] + f.per_col[0][i] * across + f.per_row[0][i] * down;
    const float b1 = f.at_corner[1][i] + f.per_col[1][i] * across + f.per_row[1][i] * down;
    const float b2 = f.at_corner[2][i] + f.per_col[2][i] * across + f.per_row[2][i] * down;
    const int is_in_rect =
        static_cast<int>(col < rects.cols[i]) & static_cast<int>(row < rects.rows[i]);
    const int is_inside = static_cast<int>(min3(b0, b1, b2) >= 0.0F) & is_in_rect;
    const int is_certain = static_cast<int>(b0 >= f.certain[0][i]) &
                           static_cast<int>(b1 >= f.certain[1][i]) &
                           static_cast<int>(b2 >= f.certain[2][i]);
    const auto bits = static_cast<std::uint32_t>(is_inside) |
                      static_cast<std::uint32_t>(is_inside & is_certain) << kCertainShift;
    coverage[i] |= bits << shift;
  }
}

}  // namespace

TriangleSetup TriangleSetups::setup(unsigned lane, std::uint32_t triangle_id) const {
  return {.per_col = {per_col[0][lane], per_col[1][lane], per_col[2][lane]},
          .per_row = {per_row[0][lane], per_row[1][lane], per_row[2][lane]},
          .at_corner = {at_corner[0][lane], at_corner[1][lane], at_corner[2][lane]},
          .certain = {certain[0][lane], certain[1][lane], certain[2][lane]},
          .nearness_per_col = nearness_per_col[lane],
          .nearness_per_row = nearness_per_row[lane],
          .nearness_at_corner = nearness_at_corner[lane],
          .farthest = farthest[lane],
          .nearest = nearest[lane],
          .margin = margin[lane],
          .triangle_id = triangle_id,
          .rect = {left[lane], right[lane], top[lane], bottom[lane]}};
}

GLIDAR_SIMD void set_up_triangles(const TileTransform& transform, const CornerBlock& corners,
                                  TriangleSetups& footprints) {
  std::array<CornerProjection, 3> projections;
  Lanes<float> sign;
  project_corners(transform, corners.c0, projections[0]);
  project_corners(transform, corners.c1, projections[1]);
  project_corners(transform, corners.c2, projections[2]);
  bound(transform, projections, footprints);
  find_nearness(transform, projections, sign, footprints);
  find_edge(projections[0], projections[1], sign, 0, footprints);
  find_edge(projections[1], projections[2], sign, 1, footprints);
  find_edge(projections[2], projections[0], sign, 2, footprints);
}

GLIDAR_SIMD std::uint32_t coverage_masks(const TriangleSetups& f, Lanes<std::uint32_t>& coverage) {
  SmallRects rects;
  for (unsigned i = 0; i < kLanes; ++i) {
    const bool is_small = f.size[i] == static_cast<int>(SizeClass::small);
    rects.cols[i] = is_small ? f.right[i] - f.left[i] + 1 : 0;
    rects.rows[i] = is_small ? f.bottom[i] - f.top[i] + 1 : 0;
    coverage[i] = 0;
  }
  const std::int32_t cols = largest(rects.cols);
  const std::int32_t rows = largest(rects.rows);
  for (std::int32_t row = 0; row < rows; ++row) {
    for (std::int32_t col = 0; col < cols; ++col) test_pixel(f, rects, col, row, coverage);
  }
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const int is_larger = static_cast<int>(f.size[i] > static_cast<int>(SizeClass::small));
    const int is_due = is_larger | static_cast<int>(coverage[i] != 0);
    bits[i] = static_cast<std::uint32_t>(is_due) << i;
  }
  std::uint32_t pending = 0;
  for (unsigned i = 0; i < kLanes; ++i) pending |= bits[i];
  return pending;
}

namespace {

/// Six times the volume of the tetrahedron of corners and sensor: positive where the triangle is
/// seen from behind, and 0 where the sensor is in its plane within the rounding of double.
double volume_of(const Eigen::Matrix3d& corners) {
  // Differences keep the precision of small, distant triangles.
  const Eigen::Vector3d first = corners.col(0);
  const double volume = first.dot((corners.col(1) - first).cross(corners.col(2) - first));
  // Its change when each corner is moved by its rounding, with a margin.
  constexpr double kRounding = 0x1p-49;
  double change = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d next = corners.col((k + 1) % 3);
    const Eigen::Vector3d last = corners.col((k + 2) % 3);
    change += corners.col(k).norm() * next.cross(last - next).norm();
  }
  return std::abs(volume) > kRounding * change ? volume : 0.0;
}

/// Bounds of a triangle in front of the sensor, within the tile; the whole tile for others.
PixelBounds around(const Eigen::Matrix3d& corners, const PixelBounds& tile) {
  constexpr double kRectMargin_px = 1e-3;
  if (!(corners.row(2).minCoeff() > 0.0)) return tile;
  const Eigen::Array3d cols = corners.row(0).array() / corners.row(2).array();
  const Eigen::Array3d rows = corners.row(1).array() / corners.row(2).array();
  const auto first = [](double low, int min_value, int max_value) {
    return static_cast<int>(
        std::ceil(std::clamp(low - kRectMargin_px, double(min_value), double(max_value))));
  };
  const auto last = [](double high, int min_value, int max_value) {
    return static_cast<int>(
        std::floor(std::clamp(high + kRectMargin_px, double(min_value), double(max_value))));
  };
  return {.left = first(cols.minCoeff(), tile.left, tile.right + 1),
          .right = last(cols.maxCoeff(), tile.left - 1, tile.right),
          .top = first(rows.minCoeff(), tile.top, tile.bottom + 1),
          .bottom = last(rows.maxCoeff(), tile.top - 1, tile.bottom)};
}

}  // namespace

std::optional<TriangleSetup> set_up_triangle(const Eigen::Matrix3d& corners,
                                             const Nearness& nearness, const PixelBounds& tile,
                                             bool cull_back_faces) {
  const double depth = corners.row(2).maxCoeff();
  if (!(depth > 0.0)) return std::nullopt;
  TriangleSetup setup{};
  setup.rect = around(corners, tile);
  if (setup.rect.left > setup.rect.right || setup.rect.top > setup.rect.bottom) return std::nullopt;
  const double volume = volume_of(corners);
  if (volume == 0.0 || (cull_back_faces && volume > 0.0)) return std::nullopt;
  const Eigen::Vector3d first_pixel(setup.rect.left, setup.rect.top, 1.0);
  const double sign = volume > 0.0 ? 1.0 : -1.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d edge = corners.col(k).cross(corners.col((k + 1) % 3));
    sum += edge;
    const double width = edge.head<2>().lpNorm<1>();
    if (!(width > 0.0)) return std::nullopt;
    const auto at = static_cast<std::size_t>(k);
    setup.per_col[at] = static_cast<float>(sign * edge.x() / width);
    setup.per_row[at] = static_cast<float>(sign * edge.y() / width);
    setup.at_corner[at] = static_cast<float>(sign * edge.dot(first_pixel) / width) + kEdgeMargin_px;
    setup.certain[at] = 2.0F * kEdgeMargin_px;
    // All pixels are outside of one edge: nothing is covered.
    const float across =
        std::max(0.0F, setup.per_col[at]) * static_cast<float>(setup.rect.right - setup.rect.left);
    const float down =
        std::max(0.0F, setup.per_row[at]) * static_cast<float>(setup.rect.bottom - setup.rect.top);
    if (setup.at_corner[at] + across + down < 0.0F) return std::nullopt;
  }
  // 1 / depth = (sum . (column, row, 1)) / volume
  const double scale = nearness.factor * nearness.far_m;
  const Eigen::Vector3d inverse = sum / volume;
  setup.nearness_per_col = static_cast<float>(scale * inverse.x());
  setup.nearness_per_row = static_cast<float>(scale * inverse.y());
  setup.nearness_at_corner = static_cast<float>(scale * inverse.dot(first_pixel) - nearness.factor);
  const double min_depth = corners.row(2).minCoeff();
  setup.farthest = static_cast<float>(nearness.at(depth));
  setup.nearest = min_depth > 0.0 ? static_cast<float>(nearness.at(min_depth))
                                  : std::numeric_limits<float>::max();
  const auto cols = static_cast<float>(setup.rect.right - setup.rect.left + kSmall);
  const auto rows = static_cast<float>(setup.rect.bottom - setup.rect.top + kSmall);
  setup.margin = std::min(
      setup.nearest - setup.farthest,
      kInterpolation * (size_of(setup.nearness_at_corner) + size_of(setup.nearness_per_col) * cols +
                        size_of(setup.nearness_per_row) * rows));
  return setup;
}

namespace {

/// The tile into which clusters of an instance are drawn.
struct TileTarget {
  const DrawContext& context;
  std::uint32_t instance;
  std::int32_t first_col;  ///< of the image in the tile
  std::int32_t first_row;
  TileBuffer& buffer;

  [[nodiscard]] const PixelView& view() const { return context.views[instance]; }
  [[nodiscard]] std::uint32_t triangle_id(std::uint32_t primitive) const {
    return context.triangles.first(instance) + primitive;
  }
};

/// Corners must be at least this deep for single precision.
float min_depth(const TileTransform& transform, const Eigen::Vector3f& half) {
  // At a smaller fraction of the depth of the farthest corner, rounding of depths would move
  // corners.
  constexpr float kMinPart = 1.0F / 16.0F;
  // A column is a sum of three products: if their sizes add up to more than this many pixels, its
  // rounding approaches kEdgeMargin_px.
  constexpr float kMaxDrawing_px = 128.0F;
  const Eigen::Map<const Eigen::Matrix3f> matrix(transform.matrix.data());
  const Eigen::Vector3f reach = matrix.cwiseAbs() * half;
  return std::max(kMinPart * (transform.depth + reach.z()),
                  std::max(reach.x(), reach.y()) / kMaxDrawing_px);
}

TileTransform tile_transform(const TileTarget& target, const PackedMesh& mesh,
                             std::uint32_t cluster) {
  const BoxPacket& boxes = mesh.boxes[cluster / kLanes];
  const unsigned lane = cluster % kLanes;
  const Eigen::Matrix<double, 3, 4>& pixel = target.view().pixel_from_object;
  Eigen::Matrix<double, 3, 4> tile = pixel;
  tile.row(0) -= target.first_col * pixel.row(2);
  tile.row(1) -= target.first_row * pixel.row(2);
  const Eigen::Vector3d middle =
      tile.leftCols<3>() * boxes.middle.get(lane).cast<double>() + tile.col(3);
  TileTransform transform{};
  Eigen::Map<Eigen::Matrix3f>(transform.matrix.data()) = tile.leftCols<3>().cast<float>();
  transform.column = static_cast<float>(middle.x());
  transform.row = static_cast<float>(middle.y());
  transform.depth = static_cast<float>(middle.z());
  transform.before_far = static_cast<float>(target.context.nearness.far_m - middle.z());
  transform.factor = static_cast<float>(target.context.nearness.factor);
  transform.min_depth = min_depth(transform, boxes.half.get(lane));
  transform.last_col = static_cast<float>(target.buffer.cols() - 1);
  transform.last_row = static_cast<float>(target.buffer.rows() - 1);
  transform.cull_back_faces = target.context.request.cull_back_faces;
  return transform;
}

bool is_inside(const TriangleSetup& setup, float across, float down) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (setup.at_corner[k] + setup.per_col[k] * across + setup.per_row[k] * down < 0.0F) {
      return false;
    }
  }
  return true;
}

/// Draws pixel by pixel, skipping holes of the alpha mask.
void draw_with_holes(const TileTarget& target, const TriangleSetup& setup,
                     std::uint32_t primitive) {
  const CastRequest& request = target.context.request;
  const auto is_hole = [&](std::size_t beam) {
    return !blocks_beam(target.context.resolver, request.beams, beam, request.cull_back_faces,
                        {target.instance, primitive});
  };
  const std::size_t cols = request.beams.cols;
  for (int row = setup.rect.top; row <= setup.rect.bottom; ++row) {
    for (int col = setup.rect.left; col <= setup.rect.right; ++col) {
      const auto across = static_cast<float>(col - setup.rect.left);
      const auto down = static_cast<float>(row - setup.rect.top);
      const std::size_t beam = static_cast<std::size_t>(target.first_row + row) * cols +
                               static_cast<std::size_t>(target.first_col + col);
      if (!is_inside(setup, across, down) || is_hole(beam)) continue;
      const float nearness = setup.nearness_at_corner + setup.nearness_per_col * across +
                             setup.nearness_per_row * down;
      target.buffer.depth_test(col, row, std::clamp(nearness, setup.farthest, setup.nearest),
                               setup.margin, setup.triangle_id);
    }
  }
}

bool may_have_holes(const TileTarget& target, std::uint32_t primitive) {
  if (target.context.has_mask[target.instance] == 0) return false;
  const Scene& scene = target.context.resolver.scene();
  return material_of(scene, scene.instances[target.instance], primitive).alpha_cutoff > 0.0F;
}

void draw_setup(const TileTarget& target, const TriangleSetup& setup, std::uint32_t primitive) {
  if (may_have_holes(target, primitive)) {
    draw_with_holes(target, setup, primitive);
  } else {
    target.buffer.draw(setup);
  }
}

void draw_large(const TileTarget& target, std::uint32_t primitive) {
  const Mesh& mesh = target.context.resolver.mesh(target.instance);
  const Triangle& triangle = mesh.triangles[primitive];
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f& position = mesh.positions_m[triangle[static_cast<std::size_t>(k)]];
    corners.col(k) = target.view().pixel_from_object * position.cast<double>().homogeneous();
  }
  corners.row(0) -= target.first_col * corners.row(2);
  corners.row(1) -= target.first_row * corners.row(2);
  const PixelBounds all = {0, target.buffer.cols() - 1, 0, target.buffer.rows() - 1};
  std::optional<TriangleSetup> setup = set_up_triangle(corners, target.context.nearness, all,
                                                       target.context.request.cull_back_faces);
  if (!setup) return;
  setup->triangle_id = target.triangle_id(primitive);
  draw_setup(target, *setup, primitive);
}

/// Draws the pixels that a small triangle covers.
void draw_small(const TileTarget& target, const TriangleSetups& f, unsigned lane,
                std::uint32_t coverage, std::uint32_t primitive) {
  constexpr std::uint32_t kPixels = (1U << kCertainShift) - 1;
  const std::uint32_t triangle_id = target.triangle_id(primitive);
  for (std::uint32_t rest = coverage & kPixels; rest != 0; rest &= rest - 1) {
    const int bit = std::countr_zero(rest);
    const std::uint32_t certain = (coverage >> (bit + kCertainShift) & 1U) != 0 ? kCertainFlag : 0;
    const int across = bit % kSmall;
    const int down = bit / kSmall;
    const float nearness = f.nearness_at_corner[lane] +
                           f.nearness_per_col[lane] * static_cast<float>(across) +
                           f.nearness_per_row[lane] * static_cast<float>(down);
    target.buffer.depth_test(f.left[lane] + across, f.top[lane] + down,
                             std::clamp(nearness, f.farthest[lane], f.nearest[lane]),
                             f.margin[lane], triangle_id | certain);
  }
}

void draw_packet(const TileTarget& target, const TrianglePacket& packet, const TriangleSetups& f) {
  Lanes<std::uint32_t> coverage;
  for (std::uint32_t pending = coverage_masks(f, coverage); pending != 0; pending &= pending - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(pending));
    const auto size = static_cast<SizeClass>(f.size[lane]);
    const std::uint32_t primitive = packet.primitive[lane];
    if (size == SizeClass::large) {
      draw_large(target, primitive);
    } else if (size == SizeClass::medium || may_have_holes(target, primitive)) {
      draw_setup(target, f.setup(lane, target.triangle_id(primitive)), primitive);
    } else {
      draw_small(target, f, lane, coverage[lane], primitive);
    }
  }
}

const PackedMesh& mesh_of(const DrawContext& context, const VisibleCluster& cluster) {
  return context.meshes[context.resolver.scene().instances[cluster.instance].mesh];
}

std::span<const TrianglePacket> packets_of(const PackedMesh& mesh, std::uint32_t cluster) {
  const std::size_t first = cluster * kPacketsPerCluster;
  return std::span(mesh.packets)
      .subspan(first, std::min(kPacketsPerCluster, mesh.packets.size() - first));
}

}  // namespace

void prefetch(const DrawContext& context, const VisibleCluster& cluster) {
  const std::span<const TrianglePacket> packets =
      packets_of(mesh_of(context, cluster), cluster.cluster);
  constexpr std::ptrdiff_t kLine = 64;
  const auto* at = reinterpret_cast<const char*>(packets.data());
  const auto* last = reinterpret_cast<const char*>(packets.data() + packets.size());
  for (; at < last; at += kLine) __builtin_prefetch(at);
}

void draw_cluster(const DrawContext& context, const VisibleCluster& cluster,
                  const PixelPosition& first, TileBuffer& buffer) {
  const TileTarget target{context, cluster.instance, first.col, first.row, buffer};
  const PackedMesh& mesh = mesh_of(context, cluster);
  const TileTransform transform = tile_transform(target, mesh, cluster.cluster);
  TriangleSetups footprints;
  for (const TrianglePacket& packet : packets_of(mesh, cluster.cluster)) {
    set_up_triangles(transform, packet.corners, footprints);
    draw_packet(target, packet, footprints);
  }
}

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
