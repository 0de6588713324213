// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/point_image.hpp>

#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

constexpr double kHalfView = 0.4142135623730951;  // tan of half the vertical field of view, 45 deg

PointImage make_image(std::size_t width, std::size_t height) {
  return {width, height, std::vector(width * height, PointImage::kNoPoint),
          std::vector(width * height, std::numeric_limits<double>::infinity()), 0};
}

/// Draws a square of pixels where no nearer point was drawn.
struct Dot {
  double x;
  double y;
  double depth;
  std::int64_t size;
};

void draw_dot(PointImage& image, const Dot& dot, std::uint32_t point) {
  const auto width = static_cast<std::int64_t>(image.width);
  const auto height = static_cast<std::int64_t>(image.height);
  const auto left = static_cast<std::int64_t>(std::floor(dot.x)) - (dot.size - 1) / 2;
  const auto top = static_cast<std::int64_t>(std::floor(dot.y)) - (dot.size - 1) / 2;
  for (std::int64_t y = std::max<std::int64_t>(top, 0); y < std::min(top + dot.size, height); ++y) {
    for (std::int64_t x = std::max<std::int64_t>(left, 0); x < std::min(left + dot.size, width);
         ++x) {
      const auto pixel = static_cast<std::size_t>(y * width + x);
      if (dot.depth >= image.depths[pixel]) continue;  // the first of equal depths is kept
      image.depths[pixel] = dot.depth;
      image.points[pixel] = point;
    }
  }
}

/// The size of dots that would cover this fraction of the image if evenly distributed.
double dot_side(const PointImage& image, std::size_t points, double share) {
  const double pixels = static_cast<double>(image.points.size());
  return std::sqrt(share * pixels / static_cast<double>(std::max<std::size_t>(points, 1)));
}

bool is_within(const PointImage& image, double x, double y) {
  return x >= 0.0 && y >= 0.0 && x < static_cast<double>(image.width) &&
         y < static_cast<double>(image.height);
}

/// The range of the points along an axis, without outliers.
std::array<double, 2> middle_of(std::span<const Eigen::Vector3d> points_m, Eigen::Index axis) {
  constexpr double kLeftOut = 0.05;  // fraction omitted at each end
  std::vector<double> values;
  values.reserve(points_m.size());
  for (const Eigen::Vector3d& point : points_m) values.push_back(point[axis]);
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return {values[static_cast<std::size_t>(kLeftOut * last)],
          values[static_cast<std::size_t>(std::ceil((1.0 - kLeftOut) * last))]};
}

struct ViewAxes {
  Eigen::Vector3d ahead;
  Eigen::Vector3d right;
  Eigen::Vector3d down;
};

ViewAxes axes_along(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d ahead = direction.normalized();
  Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-9) right = -Eigen::Vector3d::UnitY();  // vertical view: x is up
  right.normalize();
  return {ahead, right, ahead.cross(right)};
}

}  // namespace

TopView fit_top_view(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& also_m,
                     double shape) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Eigen::Vector3d& point : points_m) {
    x.push_back(point.x());
    y.push_back(point.y());
  }
  ColourScale across = make_colour_scale(x);
  ColourScale upright = make_colour_scale(y);
  if (!across.has_values) across.low = across.high = also_m.x();
  if (!upright.has_values) upright.low = upright.high = also_m.y();
  const Eigen::Vector2d low(std::min(across.low, also_m.x()), std::min(upright.low, also_m.y()));
  const Eigen::Vector2d high(std::max(across.high, also_m.x()), std::max(upright.high, also_m.y()));
  constexpr double kMargin = 1.04;
  const double min_side_m = points_m.empty() ? 2.0 : 0.1;
  const double width = std::max(
      {kMargin * (high.x() - low.x()), kMargin * shape * (high.y() - low.y()), min_side_m});
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const Eigen::Vector2d half(0.5 * width, 0.5 * width / shape);
  return {middle.x() - half.x(), middle.x() + half.x(), middle.y() - half.y(),
          middle.y() + half.y()};
}

PointImage draw_top_view(std::span<const Eigen::Vector3d> points_m, const TopView& view,
                         std::size_t width, std::size_t height) {
  PointImage image = make_image(width, height);
  const double scale = static_cast<double>(width) / (view.right_m - view.left_m);
  const std::int64_t size =
      std::lround(std::clamp(dot_side(image, points_m.size(), 0.15), 2.0, 5.0));
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const double x = scale * (points_m[i].x() - view.left_m);
    const double y = scale * (view.top_m - points_m[i].y());
    if (!is_within(image, x, y)) {
      ++image.outside;
      continue;
    }
    draw_dot(image, {x, y, -points_m[i].z(), size}, static_cast<std::uint32_t>(i));
  }
  return image;
}

Eigen::Vector3d Perspective::project(const Eigen::Vector3d& point_m) const {
  const ViewAxes axes = axes_along(target_m - eye_m);
  const Eigen::Vector3d from_eye = point_m - eye_m;
  const double depth = axes.ahead.dot(from_eye);
  const double scale = 0.5 * static_cast<double>(height) / kHalfView / depth;
  return {0.5 * static_cast<double>(width) + scale * axes.right.dot(from_eye),
          0.5 * static_cast<double>(height) + scale * axes.down.dot(from_eye), depth};
}

Perspective fit_perspective(std::span<const Eigen::Vector3d> points_m, std::size_t width,
                            std::size_t height) {
  Eigen::AlignedBox3d box;
  if (points_m.empty()) {
    box.extend(Eigen::Vector3d::Constant(-1.0));
    box.extend(Eigen::Vector3d::Constant(1.0));
  }
  for (Eigen::Index axis = 0; axis < 3 && !points_m.empty(); ++axis) {
    const auto [low, high] = middle_of(points_m, axis);
    box.min()[axis] = low;
    box.max()[axis] = high;
  }
  const Eigen::Vector3d ahead = Eigen::Vector3d(0.8, 0.5, -0.55).normalized();
  const ViewAxes axes = axes_along(ahead);
  const double shape = static_cast<double>(width) / static_cast<double>(height);
  double distance_m = 1e-3;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d corner =
        box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)) - box.center();
    const double along = axes.ahead.dot(corner);
    distance_m =
        std::max({distance_m, std::abs(axes.right.dot(corner)) / (shape * kHalfView) - along,
                  std::abs(axes.down.dot(corner)) / kHalfView - along});
  }
  constexpr double kMargin = 1.08;  // for points at the border and the size of dots
  return {box.center() - kMargin * distance_m * ahead, box.center(), width, height};
}

PointImage draw_perspective(std::span<const Eigen::Vector3d> points_m, const Perspective& view) {
  PointImage image = make_image(view.width, view.height);
  const double typical_m = (view.target_m - view.eye_m).norm();
  const double even = dot_side(image, points_m.size(), 0.3);
  const double side = std::clamp(even, 1.5, 4.0);
  const double smallest = even < 1.0 ? 1.0 : 2.0;  // dense clouds need no larger dots
  constexpr double kMax = 7.0;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3d place = view.project(points_m[i]);
    if (!(place.z() > 0.0) || !is_within(image, place.x(), place.y())) {
      ++image.outside;
      continue;
    }
    const double size = std::clamp(side * typical_m / place.z(), smallest, kMax);
    draw_dot(image, {place.x(), place.y(), place.z(), std::lround(size)},
             static_cast<std::uint32_t>(i));
  }
  return image;
}

std::vector<double> shade_edges(const PointImage& image) {
  constexpr double kStrength = 12.0;
  constexpr double kDarkest = 0.35;
  constexpr double kSteps = 16.0;  // finer steps are invisible and nearly double the file size
  const auto width = static_cast<std::int64_t>(image.width);
  const auto height = static_cast<std::int64_t>(image.height);
  const std::int64_t reach = std::max<std::int64_t>(1, width / 1000);
  std::vector<double> shades(image.points.size(), 1.0);
  for (std::int64_t i = 0; i < width * height; ++i) {
    const auto pixel = static_cast<std::size_t>(i);
    if (image.points[pixel] == PointImage::kNoPoint) continue;
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
      constexpr std::array<int, 8> kAcross = {-1, 0, 1, -1, 1, -1, 0, 1};
      constexpr std::array<int, 8> kDown = {-1, -1, -1, 0, 0, 1, 1, 1};
      const std::int64_t x = i % width + reach * kAcross.at(static_cast<std::size_t>(k));
      const std::int64_t y = i / width + reach * kDown.at(static_cast<std::size_t>(k));
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const double before = image.depths[static_cast<std::size_t>(y * width + x)];
      if (std::isinf(before)) continue;
      sum += std::max(0.0, portable_log2(image.depths[pixel] / before));
    }
    const double shade = kDarkest + (1.0 - kDarkest) * portable_exp(-kStrength * sum);
    shades[pixel] = std::round(kSteps * shade) / kSteps;
  }
  return shades;
}

}  // namespace glidar
