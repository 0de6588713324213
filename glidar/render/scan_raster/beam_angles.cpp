// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/beam_angles.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/render/scan_raster/grid_view.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace glidar::scan_raster {
namespace {

constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
/// Tangent of 80 degrees: steeper beams do not fit into a sector.
constexpr double kMaxTangent = 5.67;
/// A sector is at least eight columns wide and must be below 57 degrees.
constexpr double kMaxStep_rad = 0.06;
constexpr double kMinStep_rad = 1e-6;
/// The step of a grid with one column, which is arbitrary.
constexpr double kAnyStep_rad = 0.01;

double wrapped(double angle_rad) {
  return angle_rad - kFullTurn_rad * std::floor(angle_rad / kFullTurn_rad + 0.5);
}

/// The row's azimuths, NaN where there is no beam.
void find_azimuths(const Beams& beams, std::uint32_t row, std::span<double> azimuths, RawRow& raw) {
  raw = {};
  const SensorAxes axes = axes_of(beams);
  raw.low_tangent = kMaxTangent;
  raw.high_tangent = -kMaxTangent;
  for (std::uint32_t c = 0; c < beams.cols; ++c) {
    const Eigen::Vector3d& d = beams.directions[std::size_t{row} * beams.cols + c];
    const double x = axes.ahead.dot(d);
    const double y = axes.left.dot(d);
    const double tangent = axes.up.dot(d) / std::sqrt(x * x + y * y);
    azimuths[c] = portable_atan2(y, x);
    if (std::isnan(azimuths[c])) continue;
    ++raw.beams;
    raw.is_steep = raw.is_steep || !(std::abs(tangent) <= kMaxTangent);
    raw.low_tangent = std::min(raw.low_tangent, tangent);
    raw.high_tangent = std::max(raw.high_tangent, tangent);
  }
}

double mean_step(std::span<const double> azimuths) {
  double sum_rad = 0.0;
  std::size_t first = azimuths.size();
  std::size_t last = 0;
  for (std::size_t c = 0; c < azimuths.size(); ++c) {
    if (std::isnan(azimuths[c])) continue;
    if (first == azimuths.size()) {
      first = c;
    } else {
      sum_rad += wrapped(azimuths[c] - azimuths[last]);
    }
    last = c;
  }
  return last > first && first < azimuths.size() ? sum_rad / static_cast<double>(last - first)
                                                 : 0.0;
}

/// Fits azimuths phase + c * step.
void fit_row(std::span<const double> azimuths, double step_rad, RawRow& raw) {
  double start_rad = std::numeric_limits<double>::quiet_NaN();
  double low_rad = 0.0;
  double high_rad = 0.0;
  for (std::size_t c = 0; c < azimuths.size(); ++c) {
    if (std::isnan(azimuths[c])) continue;
    const double rest_rad = azimuths[c] - static_cast<double>(c) * step_rad;
    if (std::isnan(start_rad)) start_rad = rest_rad;
    const double off_rad = wrapped(rest_rad - start_rad);
    low_rad = std::min(low_rad, off_rad);
    high_rad = std::max(high_rad, off_rad);
  }
  raw.phase_rad = start_rad + 0.5 * (low_rad + high_rad);
  raw.spread_rad = high_rad - low_rad;
}

/// Places a fitted row in the grid.
RowAngles place_row(const RawRow& raw, std::uint32_t source, const BeamAngles& grid) {
  RowAngles row;
  row.source = source;
  if (raw.beams == 0) return row;
  const double offset = wrapped(raw.phase_rad - grid.phase_rad) / grid.step_rad;
  const double half = 0.5 * raw.spread_rad / std::abs(grid.step_rad) + kDeviationMargin;
  row.shift = static_cast<std::int32_t>(std::floor(offset + 0.5));
  row.low_tangent = raw.low_tangent;
  row.high_tangent = raw.high_tangent;
  row.low_deviation = offset - row.shift - half;
  row.high_deviation = offset - row.shift + half;
  row.is_in_grid = !raw.is_steep && 2.0 * half <= kMaxSpread;
  return row;
}

/// Finds the step from the row with the most beams.
std::size_t find_step(const std::vector<RawRow>& raw, BeamAngles& angles) {
  const auto fullest = std::max_element(
      raw.begin(), raw.end(), [](const RawRow& a, const RawRow& b) { return a.beams < b.beams; });
  angles.step_rad = fullest->beams > 1 ? fullest->step_rad : kAnyStep_rad;
  return static_cast<std::size_t>(fullest - raw.begin());
}

const char* misfit_of_step(double step_rad) {
  if (!(std::abs(step_rad) >= kMinStep_rad)) return "beams of a row with the same azimuth";
  if (!(std::abs(step_rad) <= kMaxStep_rad)) return "columns more than 3.4 degrees apart";
  return "";
}

/// The step between two neighbours in a row; NaN where one is missing.
double step_at(const Beams& beams, const SensorAxes& axes, std::size_t beam) {
  return wrapped(azimuth_rad(axes, beams.directions[beam + 1]) -
                 azimuth_rad(axes, beams.directions[beam]));
}

}  // namespace

bool may_form_scan(const Beams& beams) {
  constexpr std::size_t kAngleSamples = 64;
  constexpr std::size_t kMinColumns = 16;
  if (beams.cols < kMinColumns) return false;
  const SensorAxes axes = axes_of(beams);
  std::array<double, kAngleSamples> steps;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kAngleSamples; ++k) {
    const std::size_t row = k * beams.rows / kAngleSamples;
    // Distributed over the columns of every row, without a regular step.
    const std::size_t column = k * 7919 % (beams.cols - 1);
    const double step = step_at(beams, axes, row * beams.cols + column);
    if (!std::isnan(step)) steps[count++] = step;
  }
  if (2 * count < kAngleSamples) return false;
  const auto end = steps.begin() + static_cast<std::ptrdiff_t>(count);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(steps.begin(), middle, end);
  const double step = *middle;
  const auto differs = [&](double other) { return !(std::abs(other - step) <= std::abs(step)); };
  return 4 * static_cast<std::size_t>(std::count_if(steps.begin(), end, differs)) < count;
}

void measure_angles(const Beams& beams, ThreadPool& thread_pool, BeamAngles& angles) {
  angles.rows.clear();
  angles.misfit.clear();
  if (beams.size() == 0) {
    angles.misfit = "no beams";
    return;
  }
  std::vector<RawRow>& raw = angles.raw;
  raw.resize(beams.rows);
  angles.azimuths_rad.resize(beams.size());
  const auto azimuths = [&](std::size_t row) {
    return std::span(angles.azimuths_rad).subspan(row * beams.cols, beams.cols);
  };
  const auto for_rows = [&](const auto& body) {
    thread_pool.parallel_for(beams.rows, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) body(row);
    });
  };
  for_rows([&](std::size_t row) {
    find_azimuths(beams, static_cast<std::uint32_t>(row), azimuths(row), raw[row]);
    raw[row].step_rad = mean_step(azimuths(row));
  });
  const std::size_t reference = find_step(raw, angles);
  angles.misfit = misfit_of_step(angles.step_rad);
  if (!angles.misfit.empty()) return;
  for_rows([&](std::size_t row) { fit_row(azimuths(row), angles.step_rad, raw[row]); });
  angles.phase_rad = raw[reference].phase_rad;
  for (std::uint32_t row = 0; row < beams.rows; ++row) {
    angles.rows.push_back(place_row(raw[row], row, angles));
  }
}

}  // namespace glidar::scan_raster
