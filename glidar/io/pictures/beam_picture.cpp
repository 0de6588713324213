// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/beam_picture.hpp>

#include <glidar/io/pictures/beam_grid.hpp>
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/math/constants.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace glidar {
namespace {

constexpr double kLonger = 900.0;  // longer side of scattered pictures, pixels
constexpr double kShorter = 90.0;  // minimum of the shorter side, pixels

/// One beam in a scattered picture, in the units of its edges.
struct Mark {
  double across;
  double up;
  std::uint32_t beam;
  double range_m;  ///< infinite: no return
};

/// Sets the size of the picture. Scales are equal along both axes unless the picture would be too
/// narrow.
void size_picture(BeamPicture& picture) {
  const double width = std::abs(picture.right - picture.left);
  const double height = picture.top - picture.bottom;
  const double scale = kLonger / std::max(width, height);
  const auto pixels = [scale](double side) {
    return static_cast<std::uint32_t>(std::lround(std::max(scale * side, kShorter)));
  };
  picture.cols = pixels(width);
  picture.rows = pixels(height);
  picture.beams.assign(std::size_t{picture.rows} * picture.cols, BeamPicture::kNoBeam);
}

/// The dot size that leaves no gaps between evenly distributed beams, up to a maximum.
std::int64_t dot_pixels(const BeamPicture& picture, std::size_t beams) {
  constexpr double kMin = 3.0;
  constexpr double kMax = 15.0;
  const double share = static_cast<double>(picture.beams.size()) / static_cast<double>(beams);
  return std::lround(std::clamp(1.2 * std::sqrt(share), kMin, kMax));
}

/// A square of pixels, clipped to the picture.
void fill_dot(BeamPicture& picture, std::int64_t left, std::int64_t top, std::int64_t dot,
              std::uint32_t beam) {
  const auto cols = static_cast<std::int64_t>(picture.cols);
  const auto rows = static_cast<std::int64_t>(picture.rows);
  for (std::int64_t row = std::max<std::int64_t>(top, 0); row < std::min(top + dot, rows); ++row) {
    const std::int64_t begin = std::max<std::int64_t>(left, 0);
    const std::int64_t end = std::min(left + dot, cols);
    for (std::int64_t col = begin; col < end; ++col)
      picture.beams[static_cast<std::size_t>(row * cols + col)] = beam;
  }
}

/// Draws a dot for every beam, the farthest first, so that the nearest is visible.
void draw_marks(BeamPicture& picture, std::vector<Mark>& marks, std::int64_t dot) {
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return a.range_m > b.range_m; });
  for (const Mark& mark : marks) {
    const double x = (mark.across - picture.left) / (picture.right - picture.left);
    const double y = (picture.top - mark.up) / (picture.top - picture.bottom);
    const bool is_inside = x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0;
    if (!is_inside) continue;
    fill_dot(picture, static_cast<std::int64_t>(x * picture.cols) - dot / 2,
             static_cast<std::int64_t>(y * picture.rows) - dot / 2, dot, mark.beam);
  }
}

/// Numbers with a margin, and minimum of the shorter side, pixels `min_side` apart.
std::pair<double, double> edges_of(double low, double high, double min_side) {
  const double margin = std::max(0.03 * (high - low), 0.5 * (min_side - (high - low)));
  return {low - margin, high + margin};
}

BeamPicture make_angle_picture(const Beams& beams, std::span<const double> range_m,
                               std::uint32_t first) {
  const SensorAxes axes = axes_of(beams);
  std::vector<Mark> marks;
  for (std::uint32_t i = first; i < first + beams.firings(); ++i) {
    const Eigen::Vector3d& d = beams.directions[i];
    if (std::isnan(d.x())) continue;
    marks.push_back(
        {kDegreesPerRadian * azimuth_rad(axes, d), kDegreesPerRadian * elevation_rad(axes, d), i,
         std::isnan(range_m[i]) ? std::numeric_limits<double>::infinity() : range_m[i]});
  }
  BeamPicture picture{.kind = BeamPicture::Kind::angles, .beams = {}, .row_elevations_deg = {}};
  Eigen::AlignedBox2d box;
  for (const Mark& mark : marks) box.extend(Eigen::Vector2d(mark.across, mark.up));
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  constexpr double kMin_deg = 1.0;
  std::tie(picture.right, picture.left) = edges_of(box.min().x(), box.max().x(), kMin_deg);
  std::tie(picture.bottom, picture.top) = edges_of(box.min().y(), box.max().y(), kMin_deg);
  size_picture(picture);
  draw_marks(picture, marks, dot_pixels(picture, std::max<std::size_t>(marks.size(), 1)));
  return picture;
}

/// The scanner and its returns from above, without distant outliers.
BeamPicture make_top_picture(const Beams& beams, std::span<const double> range_m,
                             std::uint32_t first) {
  std::vector<Mark> marks;
  std::vector<double> x = {0.0};
  std::vector<double> y = {0.0};
  for (std::uint32_t i = first; i < first + beams.firings(); ++i) {
    if (std::isnan(range_m[i])) continue;
    Eigen::Vector3d at = range_m[i] * beams.directions[i];
    if (!beams.origins_m.empty()) at += beams.origins_m[i];
    marks.push_back({at.x(), at.y(), i, range_m[i]});
    x.push_back(at.x());
    y.push_back(at.y());
  }
  const ColourScale across = make_colour_scale(x, ColourScale::Start::zero);
  const ColourScale upright = make_colour_scale(y, ColourScale::Start::zero);
  BeamPicture picture{.kind = BeamPicture::Kind::top, .beams = {}, .row_elevations_deg = {}};
  const double min_side_m = marks.empty() ? 2.0 : 0.1 * std::max(across.span(), upright.span());
  std::tie(picture.left, picture.right) = edges_of(across.low, across.high, min_side_m);
  std::tie(picture.bottom, picture.top) = edges_of(upright.low, upright.high, min_side_m);
  size_picture(picture);
  constexpr std::int64_t kDot = 5;
  draw_marks(picture, marks, kDot);
  return picture;
}

/// True for LiDARs whose beams all have one elevation.
bool is_one_line(const Beams& beams) {
  constexpr double kLevel_rad = 1e-3;
  if (beams.rows != beams.returns) return false;
  const SensorAxes axes = axes_of(beams);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3d& direction : beams.directions) {
    if (std::isnan(direction.x())) continue;
    const double elevation = elevation_rad(axes, direction);
    low = std::min(low, elevation);
    high = std::max(high, elevation);
  }
  return high - low <= kLevel_rad;
}

}  // namespace

BeamPicture make_image_picture(std::uint32_t rows, std::uint32_t cols,
                               std::uint32_t number_of_return) {
  return {.kind = BeamPicture::Kind::image,
          .rows = rows,
          .cols = cols,
          .beams = {},
          .first = number_of_return * rows * cols,
          .row_elevations_deg = {}};
}

BeamPicture make_beam_picture(const Beams& beams, std::span<const double> range_m,
                              std::uint32_t number_of_return) {
  const auto first = static_cast<std::uint32_t>(number_of_return * beams.firings());
  if (looks_along_z(beams))
    return make_image_picture(beams.rows / beams.returns, beams.cols, number_of_return);
  if (is_one_line(beams)) return make_top_picture(beams, range_m, first);
  if (std::optional<BeamPicture> grid = make_grid_picture(beams, first)) return *std::move(grid);
  return make_angle_picture(beams, range_m, first);
}

}  // namespace glidar
