// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_grid.hpp>

#include <glidar/io/formats/point_rows.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace glidar {
namespace {

using Coordinates = Eigen::Map<const Eigen::Matrix3Xd>;

constexpr double kMaxCount = std::numeric_limits<std::int32_t>::max();
constexpr int kDefaultStep = -4;  // exponent of 0.1 mm
constexpr double kStepsPerExtent = 1e6;

struct Bounds {
  Eigen::Vector3d low;
  Eigen::Vector3d high;

  [[nodiscard]] double farthest() const {
    return low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  }
  [[nodiscard]] double extent() const {
    const double extent_m = (high - low).maxCoeff();
    return extent_m > 0.0 ? extent_m : farthest();
  }
};

Bounds bounds_of(const std::vector<double>& xyz) {
  const Coordinates points(xyz.data(), 3, static_cast<Eigen::Index>(xyz.size() / 3));
  return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
}

/// Exponent of the step for clouds of this extent, without the limit of 32 bits.
int fine_step(double extent_m) {
  constexpr int kMinStep = -22;
  int exponent = kDefaultStep;
  while (exponent > kMinStep && extent_m > 0.0 &&
         power_of_ten(exponent) * kStepsPerExtent > extent_m)
    --exponent;
  return exponent;
}

/// The origin of the counts. Far from 0 it is near the centre of the cloud, at whole metres if
/// these fit, so that numbers are easy to read.
Eigen::Vector3d offset_for(const Bounds& bounds, double scale_m) {
  constexpr double kNear_m = 1e5;
  constexpr double kMaxOff = 1e8;  // steps
  if (bounds.farthest() <= std::min(kNear_m, kMaxCount * scale_m)) return Eigen::Vector3d::Zero();
  const double unit_m = std::min(1.0, kMaxOff * scale_m);
  return ((0.5 * bounds.low + 0.5 * bounds.high) / unit_m).array().round() * unit_m;
}

/// The grid without counts.
LasGrid grid_for(const Bounds& bounds) {
  LasGrid grid;
  for (int exponent = fine_step(bounds.extent());; ++exponent) {
    grid.scale_m = power_of_ten(exponent);
    grid.offset_m = offset_for(bounds, grid.scale_m);
    const double reach_m =
        std::max((bounds.high - grid.offset_m).maxCoeff(), (grid.offset_m - bounds.low).maxCoeff());
    if (reach_m / grid.scale_m + 1.0 <= kMaxCount) return grid;
  }
}

}  // namespace

LasGrid make_las_grid(const std::vector<double>& xyz) {
  if (xyz.empty()) return {.scale_m = power_of_ten(kDefaultStep), .counts = {}};
  const Bounds bounds = bounds_of(xyz);
  LasGrid grid = grid_for(bounds);
  const Coordinates points(xyz.data(), 3, static_cast<Eigen::Index>(xyz.size() / 3));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t>& counts = grid.counts[static_cast<std::size_t>(axis)];
    const auto count_of = [&](double x_m) {
      return static_cast<std::int32_t>(std::llround((x_m - grid.offset_m[axis]) / grid.scale_m));
    };
    counts.reserve(static_cast<std::size_t>(points.cols()));
    for (const double x_m : points.row(axis))
      counts.push_back(static_cast<std::uint32_t>(count_of(x_m)));
    grid.min_m[axis] = count_of(bounds.low[axis]) * grid.scale_m + grid.offset_m[axis];
    grid.max_m[axis] = count_of(bounds.high[axis]) * grid.scale_m + grid.offset_m[axis];
  }
  return grid;
}

std::string las_rounding_warning(const std::vector<double>& xyz) {
  if (xyz.empty()) return {};
  const double moved_m = 0.5 * grid_for(bounds_of(xyz)).scale_m;
  if (moved_m <= kFinePosition_m) return {};
  return fmt::format(
      "LAS stores coordinates in 32 bits, and a cloud of this size in steps of {:g} m, which moves "
      "its points by up to {:g} m; write .npz, .csv or .ply, which store distant points exactly",
      2.0 * moved_m, moved_m);
}

}  // namespace glidar
