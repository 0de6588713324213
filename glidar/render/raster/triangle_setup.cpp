// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/raster/triangle_setup.hpp>

#include <glidar/math/simd.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar::raster {
namespace {

// Columns and rows of corners from this to that are known well enough in single precision.
constexpr float kMin_px = -64.0F;
constexpr float kMax_px = 192.0F;

// Eight roundings, of each term of an interpolation.
constexpr float kInterpolation = 0x1p-21F;

/// A corner of each triangle on the canvas.
struct Spot {
  Lanes<float> col;
  Lanes<float> row;
  Lanes<float> nearness;
  Lanes<float> depth;
};

[[gnu::always_inline]] inline void find_spot(const Aim& aim, const Lanes3<float>& corner,
                                             Spot& spot) {
  const float* m = aim.turn.data();
  for (unsigned i = 0; i < kLanes; ++i) {
    const float x = corner.x[i];
    const float y = corner.y[i];
    const float z = corner.z[i];
    const float deeper = m[2] * x + m[5] * y + m[8] * z;
    const float depth = aim.depth + deeper;
    const float inverse = 1.0F / depth;
    spot.col[i] = (aim.column + (m[0] * x + m[3] * y + m[6] * z)) * inverse;
    spot.row[i] = (aim.row + (m[1] * x + m[4] * y + m[7] * z)) * inverse;
    spot.nearness[i] = (aim.before_far - deeper) * aim.factor * inverse;
    spot.depth[i] = depth;
  }
}

[[gnu::always_inline]] inline float size_of(float value) {
  return value < 0.0F ? -value : value;
}
[[gnu::always_inline]] inline float least(float a, float b, float c) {
  const float ab = a < b ? a : b;
  return ab < c ? ab : c;
}
[[gnu::always_inline]] inline float most(float a, float b, float c) {
  const float ab = a > b ? a : b;
  return ab > c ? ab : c;
}
[[gnu::always_inline]] inline float held(float value, float low, float high) {
  const float above = value > low ? value : low;  // low where it is not a number
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
  std::int32_t most = values[0];
  for (unsigned i = 0; i < kLanes; ++i) most = values[i] > most ? values[i] : most;
  return most;
}

/// The pixels that a triangle may cover, and what is to be done about it.
[[gnu::always_inline]] inline void bound(const Aim& aim, const std::array<Spot, 3>& spots,
                                         Footprints& f) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float left = least(spots[0].col[i], spots[1].col[i], spots[2].col[i]);
    const float right = most(spots[0].col[i], spots[1].col[i], spots[2].col[i]);
    const float top = least(spots[0].row[i], spots[1].row[i], spots[2].row[i]);
    const float bottom = most(spots[0].row[i], spots[1].row[i], spots[2].row[i]);
    const float depth = least(spots[0].depth[i], spots[1].depth[i], spots[2].depth[i]);
    f.left[i] = rounded_up(held(left - kBorderRoom_px, 0.0F, aim.last_col + 1.0F));
    f.right[i] = rounded_down(held(right + kBorderRoom_px, -1.0F, aim.last_col));
    f.top[i] = rounded_up(held(top - kBorderRoom_px, 0.0F, aim.last_row + 1.0F));
    f.bottom[i] = rounded_down(held(bottom + kBorderRoom_px, -1.0F, aim.last_row));
    const int is_clear = static_cast<int>(depth > aim.least_depth);
    const int is_near = static_cast<int>(left > kMin_px) & static_cast<int>(right < kMax_px) &
                        static_cast<int>(top > kMin_px) & static_cast<int>(bottom < kMax_px);
    const int is_empty =
        static_cast<int>(f.left[i] > f.right[i]) | static_cast<int>(f.top[i] > f.bottom[i]);
    const int is_small = static_cast<int>(f.right[i] - f.left[i] < kSmall) &
                         static_cast<int>(f.bottom[i] - f.top[i] < kSmall);
    // As numbers, so that the loop stays one of vectors: small 1, medium 2, large 3.
    const int fitting = 2 - is_small;
    f.size[i] = (is_clear & is_empty) != 0 ? 0 : ((is_clear & is_near) != 0 ? fitting : 3);
  }
}

/// A border from corner a to b of all triangles, positive on the side of `sign`.
[[gnu::always_inline]] inline void find_border(const Spot& a, const Spot& b,
                                               const Lanes<float>& sign, std::size_t k,
                                               Footprints& f) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float per_col = sign[i] * (a.row[i] - b.row[i]);
    const float per_row = sign[i] * (b.col[i] - a.col[i]);
    const float width =
        (per_col < 0.0F ? -per_col : per_col) + (per_row < 0.0F ? -per_row : per_row);
    f.per_col[k][i] = per_col;
    f.per_row[k][i] = per_row;
    f.at_corner[k][i] = per_col * (static_cast<float>(f.left[i]) - a.col[i]) +
                        per_row * (static_cast<float>(f.top[i]) - a.row[i]) +
                        kBorderRoom_px * width;
    f.certain[k][i] = 2.0F * kBorderRoom_px * width;
  }
}

/// Signs of the triangles' areas, and nearness; what has no area or is culled is dropped.
[[gnu::always_inline]] inline void find_nearness(const Aim& aim, const std::array<Spot, 3>& spots,
                                                 Lanes<float>& sign, Footprints& f) {
  for (unsigned i = 0; i < kLanes; ++i) {
    const float col = spots[0].col[i];
    const float row = spots[0].row[i];
    const float near = spots[0].nearness[i];
    const float col_1 = spots[1].col[i] - col;
    const float row_1 = spots[1].row[i] - row;
    const float near_1 = spots[1].nearness[i] - near;
    const float col_2 = spots[2].col[i] - col;
    const float row_2 = spots[2].row[i] - row;
    const float near_2 = spots[2].nearness[i] - near;
    const float area = col_1 * row_2 - col_2 * row_1;  // positive: seen from behind
    const float inverse = 1.0F / area;
    sign[i] = area < 0.0F ? -1.0F : 1.0F;
    f.nearness_per_col[i] = (near_1 * row_2 - near_2 * row_1) * inverse;
    f.nearness_per_row[i] = (near_2 * col_1 - near_1 * col_2) * inverse;
    f.nearness_at_corner[i] = near + f.nearness_per_col[i] * (static_cast<float>(f.left[i]) - col) +
                              f.nearness_per_row[i] * (static_cast<float>(f.top[i]) - row);
    f.farthest[i] = least(near, spots[1].nearness[i], spots[2].nearness[i]);
    f.nearest[i] = most(near, spots[1].nearness[i], spots[2].nearness[i]);
    // Sizes of the terms of the area and of the gradient: their roundings count as many times more
    // as the terms cancel out.
    const float area_terms = size_of(col_1 * row_2) + size_of(col_2 * row_1);
    const float across = size_of(near_1 * row_2) + size_of(near_2 * row_1);
    const float down = size_of(near_2 * col_1) + size_of(near_1 * col_2);
    const float farther_col =
        static_cast<float>(f.right[i] - f.left[i]) + size_of(static_cast<float>(f.left[i]) - col);
    const float farther_row =
        static_cast<float>(f.bottom[i] - f.top[i]) + size_of(static_cast<float>(f.top[i]) - row);
    const float steepness = (across * farther_col + down * farther_row) * size_of(inverse);
    const float room = kInterpolation * (1.0F + area_terms * size_of(inverse)) * steepness;
    const float whole = f.nearest[i] - f.farthest[i];  // nearness is held within it
    f.room[i] = room < whole ? room : whole;
    const int is_culled = static_cast<int>(aim.cull_back_faces) & static_cast<int>(area > 0.0F);
    const int is_gone = (is_culled | static_cast<int>(area == 0.0F)) &
                        static_cast<int>(f.size[i] != static_cast<int>(Size::large));
    f.size[i] = is_gone != 0 ? 0 : f.size[i];
  }
}

/// Sizes of small triangles' rectangles; nothing for all others.
struct SmallRects {
  Lanes<std::int32_t> cols;
  Lanes<std::int32_t> rows;
};

/// Looks at one pixel of each small triangle's rectangle.
[[gnu::always_inline]] inline void cover_pixel(const Footprints& f, const SmallRects& rects,
                                               std::int32_t col, std::int32_t row,
                                               Lanes<std::uint32_t>& covered) {
  const auto across = static_cast<float>(col);
  const auto down = static_cast<float>(row);
  const std::int32_t shift = kSmall * row + col;
  for (unsigned i = 0; i < kLanes; ++i) {
    const float b0 = f.at_corner[0][i] + f.per_col[0][i] * across + f.per_row[0][i] * down;
    const float b1 = f.at_corner[1][i] + f.per_col[1][i] * across + f.per_row[1][i] * down;
    const float b2 = f.at_corner[2][i] + f.per_col[2][i] * across + f.per_row[2][i] * down;
    const int is_in_rect =
        static_cast<int>(col < rects.cols[i]) & static_cast<int>(row < rects.rows[i]);
    const int is_inside = static_cast<int>(least(b0, b1, b2) >= 0.0F) & is_in_rect;
    const int is_certain = static_cast<int>(b0 >= f.certain[0][i]) &
                           static_cast<int>(b1 >= f.certain[1][i]) &
                           static_cast<int>(b2 >= f.certain[2][i]);
    const auto bits = static_cast<std::uint32_t>(is_inside) |
                      static_cast<std::uint32_t>(is_inside & is_certain) << kCertainShift;
    covered[i] |= bits << shift;
  }
}

}  // namespace

Shape Footprints::shape(unsigned lane, std::uint32_t number) const {
  return {.per_col = {per_col[0][lane], per_col[1][lane], per_col[2][lane]},
          .per_row = {per_row[0][lane], per_row[1][lane], per_row[2][lane]},
          .at_corner = {at_corner[0][lane], at_corner[1][lane], at_corner[2][lane]},
          .certain = {certain[0][lane], certain[1][lane], certain[2][lane]},
          .nearness_per_col = nearness_per_col[lane],
          .nearness_per_row = nearness_per_row[lane],
          .nearness_at_corner = nearness_at_corner[lane],
          .farthest = farthest[lane],
          .nearest = nearest[lane],
          .room = room[lane],
          .number = number,
          .rect = {left[lane], right[lane], top[lane], bottom[lane]}};
}

GLIDAR_SIMD void find_footprints(const Aim& aim, const CornerBlock& corners,
                                 Footprints& footprints) {
  std::array<Spot, 3> spots;
  Lanes<float> sign;
  find_spot(aim, corners.c0, spots[0]);
  find_spot(aim, corners.c1, spots[1]);
  find_spot(aim, corners.c2, spots[2]);
  bound(aim, spots, footprints);
  find_nearness(aim, spots, sign, footprints);
  find_border(spots[0], spots[1], sign, 0, footprints);
  find_border(spots[1], spots[2], sign, 1, footprints);
  find_border(spots[2], spots[0], sign, 2, footprints);
}

GLIDAR_SIMD std::uint32_t cover(const Footprints& f, Lanes<std::uint32_t>& covered) {
  SmallRects rects;
  for (unsigned i = 0; i < kLanes; ++i) {
    const bool is_small = f.size[i] == static_cast<int>(Size::small);
    rects.cols[i] = is_small ? f.right[i] - f.left[i] + 1 : 0;
    rects.rows[i] = is_small ? f.bottom[i] - f.top[i] + 1 : 0;
    covered[i] = 0;
  }
  const std::int32_t cols = largest(rects.cols);
  const std::int32_t rows = largest(rects.rows);
  for (std::int32_t row = 0; row < rows; ++row) {
    for (std::int32_t col = 0; col < cols; ++col) cover_pixel(f, rects, col, row, covered);
  }
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const int is_larger = static_cast<int>(f.size[i] > static_cast<int>(Size::small));
    const int is_due = is_larger | static_cast<int>(covered[i] != 0);
    bits[i] = static_cast<std::uint32_t>(is_due) << i;
  }
  std::uint32_t due = 0;
  for (unsigned i = 0; i < kLanes; ++i) due |= bits[i];
  return due;
}

namespace {

/// Six times the volume that the corners and the sensor span: positive where the triangle is seen
/// from behind, and 0 where the sensor lies in its plane as far as double tells.
double volume_of(const Eigen::Matrix3d& corners) {
  // By differences, which keep the digits of small triangles far away.
  const Eigen::Vector3d first = corners.col(0);
  const double volume = first.dot((corners.col(1) - first).cross(corners.col(2) - first));
  // What it changes by when each corner is moved by its own rounding, and some more.
  constexpr double kRounding = 0x1p-49;
  double change = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d next = corners.col((k + 1) % 3);
    const Eigen::Vector3d last = corners.col((k + 2) % 3);
    change += corners.col(k).norm() * next.cross(last - next).norm();
  }
  return std::abs(volume) > kRounding * change ? volume : 0.0;
}

/// The part of the canvas that a triangle in front of the sensor may cover; all of it for others.
CanvasRect around(const Eigen::Matrix3d& corners, const CanvasRect& canvas) {
  constexpr double kFootprintRoom_px = 1e-3;
  if (!(corners.row(2).minCoeff() > 0.0)) return canvas;
  const Eigen::Array3d cols = corners.row(0).array() / corners.row(2).array();
  const Eigen::Array3d rows = corners.row(1).array() / corners.row(2).array();
  const auto first = [](double low, int least, int most) {
    return static_cast<int>(
        std::ceil(std::clamp(low - kFootprintRoom_px, double(least), double(most))));
  };
  const auto last = [](double high, int least, int most) {
    return static_cast<int>(
        std::floor(std::clamp(high + kFootprintRoom_px, double(least), double(most))));
  };
  return {.left = first(cols.minCoeff(), canvas.left, canvas.right + 1),
          .right = last(cols.maxCoeff(), canvas.left - 1, canvas.right),
          .top = first(rows.minCoeff(), canvas.top, canvas.bottom + 1),
          .bottom = last(rows.maxCoeff(), canvas.top - 1, canvas.bottom)};
}

}  // namespace

std::optional<Shape> shape_of(const Eigen::Matrix3d& corners, const Nearness& nearness,
                              const CanvasRect& canvas, bool cull_back_faces) {
  const double volume = volume_of(corners);
  const double depth = corners.row(2).maxCoeff();
  if (!(depth > 0.0) || volume == 0.0 || (cull_back_faces && volume > 0.0)) {
    return std::nullopt;
  }
  Shape shape{};
  shape.rect = around(corners, canvas);
  if (shape.rect.left > shape.rect.right || shape.rect.top > shape.rect.bottom) return std::nullopt;
  const Eigen::Vector3d first_pixel(shape.rect.left, shape.rect.top, 1.0);
  const double sign = volume > 0.0 ? 1.0 : -1.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d border = corners.col(k).cross(corners.col((k + 1) % 3));
    sum += border;
    const double width = border.head<2>().lpNorm<1>();
    if (!(width > 0.0)) return std::nullopt;
    const auto at = static_cast<std::size_t>(k);
    shape.per_col[at] = static_cast<float>(sign * border.x() / width);
    shape.per_row[at] = static_cast<float>(sign * border.y() / width);
    shape.at_corner[at] =
        static_cast<float>(sign * border.dot(first_pixel) / width) + kBorderRoom_px;
    shape.certain[at] = 2.0F * kBorderRoom_px;
    // All pixels beyond one border: nothing is covered.
    const float across =
        std::max(0.0F, shape.per_col[at]) * static_cast<float>(shape.rect.right - shape.rect.left);
    const float down =
        std::max(0.0F, shape.per_row[at]) * static_cast<float>(shape.rect.bottom - shape.rect.top);
    if (shape.at_corner[at] + across + down < 0.0F) return std::nullopt;
  }
  // 1 / depth = (sum . (column, row, 1)) / volume
  const double scale = nearness.factor * nearness.far_m;
  const Eigen::Vector3d inverse = sum / volume;
  shape.nearness_per_col = static_cast<float>(scale * inverse.x());
  shape.nearness_per_row = static_cast<float>(scale * inverse.y());
  shape.nearness_at_corner = static_cast<float>(scale * inverse.dot(first_pixel) - nearness.factor);
  const double least_depth = corners.row(2).minCoeff();
  shape.farthest = static_cast<float>(nearness.at(depth));
  shape.nearest = least_depth > 0.0 ? static_cast<float>(nearness.at(least_depth))
                                    : std::numeric_limits<float>::max();
  const auto cols = static_cast<float>(shape.rect.right - shape.rect.left + kSmall);
  const auto rows = static_cast<float>(shape.rect.bottom - shape.rect.top + kSmall);
  shape.room = std::min(
      shape.nearest - shape.farthest,
      kInterpolation * (size_of(shape.nearness_at_corner) + size_of(shape.nearness_per_col) * cols +
                        size_of(shape.nearness_per_row) * rows));
  return shape;
}

}  // namespace glidar::raster
