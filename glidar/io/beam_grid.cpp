// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/beam_grid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace glidar {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kEven_rad = 1e-3;  // a row is level to so much
constexpr double kEvenSteps = 0.5;  // and its columns are where they belong to so many steps

double wrapped(double angle_rad) {
  return angle_rad - kTurn * std::round(angle_rad / kTurn);
}

/// Azimuth and elevation of the beams of one return.
struct Angles {
  std::size_t rows;
  std::size_t cols;
  std::vector<double> azimuth_rad;  ///< NaN where there is no beam
  std::vector<double> elevation_rad;
};

Angles angles_of(const Beams& beams, std::size_t first_beam) {
  const SensorAxes axes = axes_of(beams);
  Angles angles{beams.rows / beams.returns, beams.cols, {}, {}};
  for (std::size_t i = first_beam; i < first_beam + beams.pulses(); ++i) {
    angles.azimuth_rad.push_back(azimuth_rad(axes, beams.directions[i]));
    angles.elevation_rad.push_back(elevation_rad(axes, beams.directions[i]));
  }
  return angles;
}

/// The mean step of azimuth from column to column, by all neighbours; 0 when there are none.
double step_of(const Angles& angles) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < angles.azimuth_rad.size(); ++i) {
    if ((i + 1) % angles.cols == 0) continue;
    const double step = wrapped(angles.azimuth_rad[i + 1] - angles.azimuth_rad[i]);
    if (std::isnan(step)) continue;
    sum += step;
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

/// A row's azimuth in column 0, by its first beam, and its elevation.
struct Row {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  std::size_t number = 0;
};

/// Empty unless the row is level and even.
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

/// The azimuth of the leftmost column and how many columns there are.
struct Extent {
  double left_rad;
  std::size_t cols;
  bool is_turn;
};

Extent extent_of(const std::vector<Row>& rows, double step_rad, std::size_t cols) {
  const double size_rad = std::abs(step_rad);
  if (size_rad * (static_cast<double>(cols) + 1.0) >= kTurn) return {std::numbers::pi, cols, true};
  const auto [least, greatest] =
      std::minmax_element(rows.begin(), rows.end(),
                          [](const Row& a, const Row& b) { return a.azimuth_rad < b.azimuth_rad; });
  const double across_rad = step_rad * static_cast<double>(cols - 1);
  const double left_rad = greatest->azimuth_rad + std::max(0.0, across_rad);
  const double right_rad = least->azimuth_rad + std::min(0.0, across_rad);
  return {left_rad, static_cast<std::size_t>(std::lround((left_rad - right_rad) / size_rad)) + 1,
          false};
}

}  // namespace

std::optional<BeamPicture> make_grid_picture(const Beams& beams, std::uint32_t first_beam) {
  const Angles angles = angles_of(beams, first_beam);
  const double step_rad = step_of(angles);
  const bool is_more_than_a_turn =
      std::abs(step_rad) * (static_cast<double>(angles.cols) - 1.0) > kTurn;
  if (angles.rows < 2 || angles.cols < 2 || step_rad == 0.0 || is_more_than_a_turn)
    return std::nullopt;
  const std::vector<Row> rows = rows_of(angles, step_rad);
  if (rows.empty()) return std::nullopt;
  const Extent extent = extent_of(rows, step_rad, angles.cols);
  const double size_rad = std::abs(step_rad);
  BeamPicture picture{
      .kind = BeamPicture::Kind::grid,
      .rows = static_cast<std::uint32_t>(rows.size()),
      .cols = static_cast<std::uint32_t>(extent.cols),
      .beams = std::vector<std::uint32_t>(rows.size() * extent.cols, BeamPicture::kNoBeam),
      .row_elevations_deg = {}};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    picture.row_elevations_deg.push_back(kDegrees * rows[r].elevation_rad);
    const auto shift =
        static_cast<std::int64_t>(std::lround((extent.left_rad - rows[r].azimuth_rad) / size_rad));
    for (std::size_t col = 0; col < angles.cols; ++col) {
      const auto along = static_cast<std::int64_t>(col);
      std::int64_t place = shift + (step_rad < 0.0 ? along : -along);
      const auto cols = static_cast<std::int64_t>(extent.cols);
      if (extent.is_turn) place = ((place % cols) + cols) % cols;
      const auto pixel = r * extent.cols + static_cast<std::size_t>(place);
      picture.beams[pixel] =
          first_beam + static_cast<std::uint32_t>(rows[r].number * angles.cols + col);
    }
  }
  const double across_rad = extent.is_turn ? kTurn : size_rad * static_cast<double>(extent.cols);
  picture.left = kDegrees * (extent.left_rad + (extent.is_turn ? 0.0 : 0.5 * size_rad));
  picture.right = picture.left - kDegrees * across_rad;
  picture.top = picture.row_elevations_deg.front();
  picture.bottom = picture.row_elevations_deg.back();
  return picture;
}

}  // namespace glidar
