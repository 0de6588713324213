// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/beam_grid.hpp>

#include <glidar/math/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

}  // namespace

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

}  // namespace glidar
