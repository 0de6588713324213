// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/scanner_grid.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/render/common/rounding.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::scan_raster {
namespace {

/// Maximum width of half a sector, with two more columns on each side: wide enough for buffers that
/// fill a core's private cache, narrow enough for tight rectangles.
constexpr double kMaxHalfSector_rad = 0.42;
constexpr std::uint32_t kMaxSectorColumns = 128;
/// Maximum overlap of rows: the sum of their intervals of elevations, relative to the whole
/// interval.
constexpr double kMaxCrowding = 4.0;
/// Maximum fraction of cells without a beam because rows start at different azimuths, plus a
/// constant.
constexpr double kMaxShifted = 0.5;
constexpr std::uint32_t kShiftedMargin = 64;
/// Error bound of the kernels' tangents of elevations: some roundings of numbers up to 6.
constexpr double kTangentMargin = 0x1p-19;
/// Error bound of their arc tangent, see arc_tangent().
constexpr double kAzimuthMargin_rad = 2e-5;

/// Padding on each side of a sector, columns.
double margin_of(const std::vector<RowAngles>& rows) {
  double margin = 0.0;
  for (const RowAngles& row : rows) {
    margin = std::max({margin, -row.low_deviation, row.high_deviation});
  }
  return margin + 2.0;
}

/// Forward at an azimuth, to the side of rising columns, up.
Eigen::Matrix3d sector_frame(const SensorAxes& axes, double azimuth_rad, bool rises) {
  const Eigen::Vector3d forward =
      portable_cos(azimuth_rad) * axes.ahead + portable_sin(azimuth_rad) * axes.left;
  const Eigen::Vector3d left =
      portable_cos(azimuth_rad) * axes.left - portable_sin(azimuth_rad) * axes.ahead;
  Eigen::Matrix3d rows;
  rows.row(0) = forward;
  rows.row(1) = rises ? left : Eigen::Vector3d(-left);
  rows.row(2) = axes.up;
  return rows;
}

}  // namespace

void ScannerGrid::measure(const Beams& beams, ThreadPool& thread_pool) {
  measure_angles(beams, thread_pool, angles_);
  sort_rows();
  if (angles_.misfit.empty()) find_misfit(beams);
  if (!angles_.misfit.empty()) {
    sectors_.clear();
    return;
  }
  find_columns(beams);
  find_bins();
  build_sectors(beams, thread_pool);
}

/// Makes both ends of the rows' elevations increase, which only widens them.
void ScannerGrid::sort_rows() {
  rows_.clear();
  other_rows_.clear();
  for (const RowAngles& row : angles_.rows) {
    if (row.is_in_grid) {
      rows_.push_back(row);
    } else {
      other_rows_.push_back(row.source);
    }
  }
  std::sort(rows_.begin(), rows_.end(), [](const RowAngles& a, const RowAngles& b) {
    const double a_middle = a.low_tangent + a.high_tangent;
    const double b_middle = b.low_tangent + b.high_tangent;
    return a_middle != b_middle ? a_middle < b_middle : a.source < b.source;
  });
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    rows_[i].high_tangent = std::max(rows_[i].high_tangent, rows_[i - 1].high_tangent);
  }
  for (std::size_t i = rows_.size(); i > 1; --i) {
    rows_[i - 2].low_tangent = std::min(rows_[i - 2].low_tangent, rows_[i - 1].low_tangent);
  }
}

void ScannerGrid::find_misfit(const Beams& beams) {
  if (2 * rows_.size() < beams.rows || rows_.empty()) {
    angles_.misfit = "beams without rows of equal columns (such as the sub-rays of footprints)";
    return;
  }
  double sum = 0.0;
  for (const RowAngles& row : rows_) sum += row.high_tangent - row.low_tangent;
  const double whole = rows_.back().high_tangent - rows_.front().low_tangent;
  if (sum > kMaxCrowding * beams.returns * whole) {
    angles_.misfit = "rows that are no lines of equal elevation";
    return;
  }
  const auto by_shift = [](const RowAngles& a, const RowAngles& b) { return a.shift < b.shift; };
  const auto [least, greatest] = std::minmax_element(rows_.begin(), rows_.end(), by_shift);
  columns_.first = least->shift;
  columns_.count = beams.cols + static_cast<std::uint32_t>(greatest->shift - least->shift);
  if (columns_.count - beams.cols > kMaxShifted * beams.cols + kShiftedMargin) {
    angles_.misfit = "rows that begin at very different azimuths";
  }
}

void ScannerGrid::find_columns(const Beams& beams) {
  columns_.phase_rad = angles_.phase_rad;
  columns_.step_rad = angles_.step_rad;
  const double half = kMaxHalfSector_rad / std::abs(angles_.step_rad) - margin_of(rows_);
  const auto max_columns = static_cast<std::uint32_t>(
      std::clamp(2.0 * half, double{kTileColumns}, double{kMaxSectorColumns}));
  shape_ = SectorShape::around(beams.cols, static_cast<std::uint32_t>(rows_.size()));
  shape_.columns = std::min(max_columns / kTileColumns * kTileColumns, shape_.columns);
  low_deviation_.clear();
  high_deviation_.clear();
  for (const RowAngles& row : rows_) {
    low_deviation_.push_back(next_below(row.low_deviation));
    high_deviation_.push_back(next_above(row.high_deviation));
  }
}

void ScannerGrid::find_bins() {
  // A margin, so that a bin is never narrower than the error of tangents.
  constexpr double kAround = 1e-2;
  lowest_tangent_ = rows_.front().low_tangent - kAround;
  highest_tangent_ = rows_.back().high_tangent + kAround;
  const double width = (highest_tangent_ - lowest_tangent_) / kElevationBins;
  first_row_.resize(kElevationBins + 1);
  last_row_.resize(kElevationBins + 1);
  const double margin = kTangentMargin + 0.02 * width;
  for (std::uint32_t bin = 0; bin <= kElevationBins; ++bin) {
    const double bottom = lowest_tangent_ + bin * width - margin;
    const double top = lowest_tangent_ + (bin + 1) * width + margin;
    const auto first = std::partition_point(
        rows_.begin(), rows_.end(), [&](const RowAngles& r) { return r.high_tangent < bottom; });
    const auto end = std::partition_point(rows_.begin(), rows_.end(),
                                          [&](const RowAngles& r) { return r.low_tangent <= top; });
    first_row_[bin] = static_cast<std::int32_t>(first - rows_.begin());
    last_row_[bin] = static_cast<std::int32_t>(end - rows_.begin()) - 1;
  }
}

void ScannerGrid::build_sectors(const Beams& beams, ThreadPool& thread_pool) {
  sectors_.resize((columns_.count + shape_.columns - 1) / shape_.columns);
  const SensorAxes axes = axes_of(beams);
  const auto build = [&](std::size_t i, std::vector<RowStart>& starts) {
    const std::int64_t first = columns_.first + static_cast<std::int64_t>(i * shape_.columns);
    starts.clear();
    for (const RowAngles& row : rows_) starts.push_back({row.source, first - row.shift});
    const double middle = static_cast<double>(first) + 0.5 * shape_.columns - 0.5;
    const Eigen::Matrix3d frame = sector_frame(
        axes, columns_.phase_rad + middle * columns_.step_rad, columns_.step_rad > 0.0);
    sectors_[i].build(beams, shape_, {frame, frame}, starts);
  };
  thread_pool.parallel_for(sectors_.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<RowStart> starts;
    for (std::size_t i = begin; i < end; ++i) build(i, starts);
  });
}

GridView ScannerGrid::view() const {
  GridView view{};
  set_shape(shape_, view);
  const double step_rad = std::abs(columns_.step_rad);
  view.columns_per_unit = static_cast<float>(1.0 / step_rad);
  view.middle_column = 0.5F * static_cast<float>(shape_.columns) - 0.5F;
  view.column_margin = static_cast<float>(kCellMargin + kAzimuthMargin_rad / step_rad);
  const double half_rad = (0.5 * shape_.columns + margin_of(rows_)) * step_rad;
  view.max_slope = next_above(portable_tan(half_rad));
  const double secant = 1.0001 / portable_cos(half_rad);
  view.lowest_slope = next_below(std::min(lowest_tangent_, lowest_tangent_ * secant));
  view.highest_slope = next_above(std::max(highest_tangent_, highest_tangent_ * secant));
  view.elevations = {
      .lowest_tangent = next_below(lowest_tangent_),
      .highest_tangent = next_above(highest_tangent_),
      .bins_per_tangent = static_cast<float>(kElevationBins / (highest_tangent_ - lowest_tangent_)),
      .first_row = first_row_.data(),
      .last_row = last_row_.data()};
  set_deviations(low_deviation_, high_deviation_, view);
  return view;
}

}  // namespace glidar::scan_raster
