// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/beam_picture.hpp>

#include <glidar/core/beams.hpp>
#include <glidar/io/pictures/colour_scale.hpp>
#include <glidar/math/constants.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace glidar {
namespace {

constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
constexpr double kEven_rad = 1e-3;  // tolerance of a row's elevation
constexpr double kEvenSteps = 0.5;  // tolerance of a column's azimuth, in steps

double wrapped(double angle_rad) {
  return angle_rad - kFullTurn_rad * std::round(angle_rad / kFullTurn_rad);
}

/// Azimuth and elevation of the beams of one return.
struct Angles {
  std::size_t rows;
  std::size_t cols;
  std::size_t first_col;  ///< the first column of the picture; the others follow cyclically
  std::vector<double> azimuth_rad;  ///< NaN for no beam
  std::vector<double> elevation_rad;
};

Angles angles_of(const Beams& beams, std::size_t first_beam) {
  const SensorAxes axes = axes_of(beams);
  Angles angles{beams.rows / beams.returns, beams.cols, 0, {}, {}};
  for (std::size_t i = first_beam; i < first_beam + beams.firings(); ++i) {
    angles.azimuth_rad.push_back(azimuth_rad(axes, beams.directions[i]));
    angles.elevation_rad.push_back(elevation_rad(axes, beams.directions[i]));
  }
  return angles;
}

/// The azimuth steps between columns in all rows; NaN next to a missing beam and at the end of a
/// row.
std::vector<double> steps_of(const Angles& angles) {
  std::vector<double> steps(angles.azimuth_rad.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if ((i + 1) % angles.cols != 0)
      steps[i] = wrapped(angles.azimuth_rad[i + 1] - angles.azimuth_rad[i]);
  }
  return steps;
}

/// The median; NaN without numbers.
double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The typical step, and the column after which the azimuth jumps:
/// a sector in which the frame starts in the middle. The last column when there is no jump.
struct Steps {
  double mean_rad = 0.0;
  std::size_t jump_col = 0;
};

/// The step is 0 without beams.
Steps typical_steps(const Angles& angles) {
  const std::vector<double> steps = steps_of(angles);
  const double typical_rad = median(steps);
  Steps found{0.0, angles.cols - 1};
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (std::isnan(steps[i])) continue;
    if (std::abs(steps[i] - typical_rad) > std::abs(typical_rad)) {
      found.jump_col = i % angles.cols;
      continue;
    }
    sum += steps[i];
    ++count;
  }
  if (count > 0) found.mean_rad = sum / static_cast<double>(count);
  return found;
}

/// Rotates every row to begin with the column after the jump.
void begin_after(Angles& angles, std::size_t jump_col) {
  angles.first_col = (jump_col + 1) % angles.cols;
  for (std::vector<double>* values : {&angles.azimuth_rad, &angles.elevation_rad}) {
    for (std::size_t row = 0; row < angles.rows; ++row) {
      const auto begin = values->begin() + static_cast<std::ptrdiff_t>(row * angles.cols);
      std::rotate(begin, begin + static_cast<std::ptrdiff_t>(angles.first_col),
                  begin + static_cast<std::ptrdiff_t>(angles.cols));
    }
  }
}

/// A row's azimuth in column 0, extrapolated from its first beam, and its elevation.
struct Row {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  std::size_t number = 0;
};

/// Empty unless the row has one elevation and even steps.
std::optional<Row> row_of(const Angles& angles, std::size_t number, double step_rad) {
  std::optional<Row> row;
  for (std::size_t col = 0; col < angles.cols; ++col) {
    const std::size_t i = number * angles.cols + col;
    if (std::isnan(angles.azimuth_rad[i])) continue;
    const double start_rad = angles.azimuth_rad[i] - step_rad * static_cast<double>(col);
    if (!row) row = Row{start_rad, angles.elevation_rad[i], number};
    const bool is_even =
        std::abs(wrapped(start_rad - row->azimuth_rad)) <= kEvenSteps * std::abs(step_rad);
    const bool is_level = std::abs(angles.elevation_rad[i] - row->elevation_rad) <= kEven_rad;
    if (!is_even || !is_level) return std::nullopt;
  }
  return row;
}

/// All rows, the highest first, their azimuths in column 0 within half a turn of the first's.
std::vector<Row> rows_of(const Angles& angles, double step_rad) {
  std::vector<Row> rows;
  for (std::size_t number = 0; number < angles.rows; ++number) {
    const std::optional<Row> row = row_of(angles, number, step_rad);
    if (!row) return {};
    rows.push_back(*row);
  }
  for (Row& row : rows)
    row.azimuth_rad = rows[0].azimuth_rad + wrapped(row.azimuth_rad - rows[0].azimuth_rad);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.elevation_rad > b.elevation_rad; });
  return rows;
}

/// Pixel numbers increase to the right, where azimuths decrease; pixel 0 has the azimuth
/// `zero_rad`.
struct Extent {
  double zero_rad;
  std::int64_t first;  ///< the leftmost pixel
  std::int64_t cols;
  bool is_turn;
};

/// The pixel of a row's column 0.
std::int64_t pixel_of(const Row& row, double zero_rad, double size_rad) {
  return std::lround((zero_rad - row.azimuth_rad) / size_rad);
}

Extent extent_of(const std::vector<Row>& rows, double step_rad, std::size_t cols) {
  const double size_rad = std::abs(step_rad);
  const auto count = static_cast<std::int64_t>(cols);
  if (size_rad * (static_cast<double>(cols) + 1.0) >= kFullTurn_rad)
    return {std::numbers::pi, 0, count, true};
  const double zero_rad = rows.front().azimuth_rad;
  std::int64_t least = 0;
  std::int64_t most = 0;
  for (const Row& row : rows) {
    const std::int64_t pixel = pixel_of(row, zero_rad, size_rad);
    least = std::min(least, pixel);
    most = std::max(most, pixel);
  }
  const std::int64_t first = step_rad < 0.0 ? least : least - (count - 1);
  return {zero_rad, first, most - least + count, false};
}

/// Sets the beam of each pixel.
void place_beams(const Angles& angles, const std::vector<Row>& rows, const Extent& extent,
                 double step_rad, std::uint32_t first_beam, BeamPicture& picture) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::int64_t start =
        pixel_of(rows[r], extent.zero_rad, std::abs(step_rad)) - extent.first;
    for (std::size_t col = 0; col < angles.cols; ++col) {
      const auto along = static_cast<std::int64_t>(col);
      std::int64_t place = start + (step_rad < 0.0 ? along : -along);
      if (extent.is_turn) place = ((place % extent.cols) + extent.cols) % extent.cols;
      const std::size_t beam_col = (col + angles.first_col) % angles.cols;
      picture.beams.at(r * picture.cols + static_cast<std::size_t>(place)) =
          first_beam + static_cast<std::uint32_t>(rows[r].number * angles.cols + beam_col);
    }
  }
}

/// A grid of rows with one elevation each and even steps of azimuth, shifted so that all rows have
/// the same azimuth in a column, highest row on top; empty for other beams. A full rotation begins
/// behind the sensor; for a sector the picture covers all rows.
std::optional<BeamPicture> make_grid_picture(const Beams& beams, std::uint32_t first_beam) {
  Angles angles = angles_of(beams, first_beam);
  if (angles.rows < 2 || angles.cols < 2) return std::nullopt;
  const auto [step_rad, jump_col] = typical_steps(angles);
  const double size_rad = std::abs(step_rad);
  const bool is_more_than_a_turn =
      size_rad * (static_cast<double>(angles.cols) - 1.0) > kFullTurn_rad;
  if (step_rad == 0.0 || is_more_than_a_turn) return std::nullopt;
  begin_after(angles, jump_col);
  const std::vector<Row> rows = rows_of(angles, step_rad);
  if (rows.empty()) return std::nullopt;
  const Extent extent = extent_of(rows, step_rad, angles.cols);
  BeamPicture picture{.kind = BeamPicture::Kind::grid,
                      .rows = static_cast<std::uint32_t>(rows.size()),
                      .cols = static_cast<std::uint32_t>(extent.cols),
                      .beams = {},
                      .row_elevations_deg = {}};
  picture.beams.assign(std::size_t{picture.rows} * picture.cols, BeamPicture::kNoBeam);
  for (const Row& row : rows)
    picture.row_elevations_deg.push_back(kDegreesPerRadian * row.elevation_rad);
  place_beams(angles, rows, extent, step_rad, first_beam, picture);
  const double across_rad =
      extent.is_turn ? kFullTurn_rad : size_rad * static_cast<double>(extent.cols);
  const double left_rad = extent.zero_rad - size_rad * static_cast<double>(extent.first);
  picture.left = kDegreesPerRadian * (left_rad + (extent.is_turn ? 0.0 : 0.5 * size_rad));
  picture.right = picture.left - kDegreesPerRadian * across_rad;
  picture.top = picture.row_elevations_deg.front();
  picture.bottom = picture.row_elevations_deg.back();
  return picture;
}

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
