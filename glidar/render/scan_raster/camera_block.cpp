// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/camera_block.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/render/common/rounding.hpp>
#include <glidar/render/scan_raster/grid_view.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace glidar::scan_raster {
namespace {

/// A map is fitted to about this many beams along each side of a block.
constexpr std::uint32_t kFitSide = 12;
/// Minimum forward / length of a beam in the frame of slopes.
constexpr double kMinForward = 0.05;
/// Where beams deviate by more, columns or rows, smaller blocks are tried.
constexpr double kMaxSmooth = 1.0;
/// Maximum shift between rows of a block, columns.
constexpr double kMaxShift = 16.0;

struct Range {
  double low = kInfinity;
  double high = -kInfinity;

  void extend(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void extend(const Range& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  [[nodiscard]] bool is_empty() const { return high < low; }
  [[nodiscard]] double width() const { return high - low; }
};

/// Calls visit(beam) for the beams of a row in every `step`th column; columns and rows are counted
/// from the block's first.
template <class Visit>
void for_row(const Beams& beams, const BeamRect& rect, std::uint32_t row, std::uint32_t step,
             const Visit& visit) {
  for (std::uint32_t column = rect.first_column; column < rect.end_column; column += step) {
    const Eigen::Vector3d& direction = beams.directions[std::size_t{row} * beams.cols + column];
    if (!direction.allFinite()) continue;
    visit(PlacedBeam{direction, static_cast<double>(column - rect.first_column),
                     static_cast<double>(row - rect.first_row)});
  }
}

/// Measures how far beams are from the cells of a map.
class Bounds {
 public:
  explicit Bounds(const ProjectiveMap& map) : map_(map) {}

  void take(const PlacedBeam& beam) {
    const Eigen::Vector3d point = map_.frame.slopes_from_sensor * beam.direction;
    const double side = point.y() / point.x();
    const double up = point.z() / point.x();
    forward_.extend(point.x());
    side_.extend(side);
    up_.extend(up);
    column_offsets_.extend(side * map_.columns_per_slope + map_.middle_column - beam.column);
    row_offsets_.extend(up * map_.rows_per_slope + map_.middle_row - beam.row);
  }

  /// Ends a row and returns the deviations of its beams from their columns.
  Range end_row() {
    const Range offsets = column_offsets_;
    column_offsets_ = {};
    all_column_offsets_.extend(offsets);
    widest_row_ = std::max(widest_row_, offsets.width());
    return offsets;
  }

  /// True if no row's deviations from columns, nor all deviations from rows, span more than
  /// `spread`.
  [[nodiscard]] bool are_within(double spread) const {
    return forward_.low > kMinForward && row_offsets_.width() <= spread && widest_row_ <= spread &&
           all_column_offsets_.width() <= kMaxShift;
  }

  void write(GridView& view) const {
    // Slopes up to half a cell beyond those of all beams are not cut off.
    const double column = 0.5 / map_.columns_per_slope;
    const double row = 0.5 / map_.rows_per_slope;
    view.columns_per_unit = static_cast<float>(map_.columns_per_slope);
    view.middle_column = static_cast<float>(map_.middle_column);
    view.column_margin = static_cast<float>(kCellMargin);
    view.max_slope = next_above(std::max(-side_.low, side_.high) + column);
    view.lowest_slope = next_below(up_.low - row);
    view.highest_slope = next_above(up_.high + row);
    view.has_slopes = true;
    const double margin = kCellMargin + kDeviationMargin;
    view.slopes = {.rows_per_slope = static_cast<float>(map_.rows_per_slope),
                   .first_row = next_below(map_.middle_row - row_offsets_.high - margin),
                   .last_row = next_above(map_.middle_row - row_offsets_.low + margin)};
  }

 private:
  const ProjectiveMap& map_;
  Range forward_;
  Range side_;
  Range up_;
  Range column_offsets_;  ///< from the columns of this row's cells
  Range all_column_offsets_;
  double widest_row_ = 0.0;
  Range row_offsets_;
};

}  // namespace

Eigen::Vector2d stereographic_point(const Eigen::Vector3d& direction) {
  return direction.head<2>() / (direction.norm() + direction.z());
}

void CameraBlock::measure(const Beams& beams) {
  set_shape(shape(), view_);
  count_beams(beams);
  if (beams_ == 0) return;
  is_drawn_ = fit(beams);
  is_rough_ = !is_drawn_;
  if (is_drawn_) bound(beams);
}

void CameraBlock::count_beams(const Beams& beams) {
  for (std::uint32_t row = rect_.first_row; row < rect_.end_row; ++row) {
    for_row(beams, rect_, row, 1, [&](const PlacedBeam& /*beam*/) { ++beams_; });
  }
}

bool CameraBlock::fit(const Beams& beams) {
  std::vector<PlacedBeam> samples;
  const std::uint32_t rows = rect_.end_row - rect_.first_row;
  const std::uint32_t columns = rect_.end_column - rect_.first_column;
  const bool is_sparse = 4 * beams_ < std::size_t{rows} * columns;
  const std::uint32_t row_step = is_sparse ? 1 : std::max(rows / kFitSide, 1U);
  const std::uint32_t column_step = is_sparse ? 1 : std::max(columns / kFitSide, 1U);
  for (std::uint32_t row = rect_.first_row; row < rect_.end_row; row += row_step) {
    for_row(beams, rect_, row, column_step, [&](const PlacedBeam& beam) {
      samples.push_back(beam);
      points_.extend(stereographic_point(beam.direction));
    });
  }
  const std::optional<ProjectiveMap> map = fit_projective_map(samples);
  if (map) map_ = *map;
  return map.has_value();
}

void CameraBlock::bound(const Beams& beams) {
  low_deviation_.assign(shape().rows, 0.0F);
  high_deviation_.assign(shape().rows, 0.0F);
  Bounds bounds(map_);
  for (std::uint32_t row = rect_.first_row; row < rect_.end_row; ++row) {
    for_row(beams, rect_, row, 1, [&](const PlacedBeam& beam) { bounds.take(beam); });
    const Range deviations = bounds.end_row();
    if (deviations.is_empty()) continue;
    low_deviation_[row - rect_.first_row] = next_below(deviations.low - kDeviationMargin);
    high_deviation_[row - rect_.first_row] = next_above(deviations.high + kDeviationMargin);
  }
  bounds.write(view_);
  is_rough_ = !bounds.are_within(kMaxSmooth);
  is_drawn_ = bounds.are_within(kMaxSpread);
}

GridView CameraBlock::view() const {
  GridView view = view_;
  if (!low_deviation_.empty()) set_deviations(low_deviation_, high_deviation_, view);
  return view;
}

}  // namespace glidar::scan_raster
