// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/projective_fit.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

namespace glidar::scan_raster {
namespace {

constexpr std::size_t kMinBeams = 16;
/// Beams farther from the middle one than 81 degrees are not fitted.
constexpr double kMinCosine = 0.15;
/// Maximum tangent of the angle between the middle beam and the forward axis, which is arbitrary
/// for long focal lengths.
constexpr double kMaxTilt = 12.0;
/// Minimum ratio of the smallest and the largest pivot of the normal equations.
constexpr double kMinPivot = 1e-10;
/// Columns or rows for a slope of 1: the limit of single precision.
constexpr double kMaxPerSlope = 1e6;
constexpr int kUnknowns = 8;

using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using NormalMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// The middle direction and two perpendicular axes.
struct MiddleFrame {
  Eigen::Vector3d middle;
  Eigen::Vector3d x;
  Eigen::Vector3d y;
  double scale = 1.0;  ///< the slopes x / middle and y / middle of beams are at most about this

  [[nodiscard]] Eigen::Vector2d slopes(const Eigen::Vector3d& d) const {
    return Eigen::Vector2d(d.dot(x), d.dot(y)) / (d.dot(middle) * scale);
  }
};

/// Scales numbers to about -1 to 1.
struct Interval {
  double middle;
  double half;

  Interval(std::span<const PlacedBeam> beams, double PlacedBeam::*of) {
    const auto less = [of](const PlacedBeam& a, const PlacedBeam& b) { return a.*of < b.*of; };
    const auto [low, high] = std::minmax_element(beams.begin(), beams.end(), less);
    middle = 0.5 * ((*low).*of + (*high).*of);
    half = std::max(0.5 * ((*high).*of - (*low).*of), 0.5);
  }
  [[nodiscard]] double operator()(double value) const { return (value - middle) / half; }
};

std::optional<MiddleFrame> find_middle(std::span<const PlacedBeam> beams) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PlacedBeam& beam : beams) sum += beam.direction;
  MiddleFrame frame;
  frame.middle = sum.normalized();
  frame.x = frame.middle.unitOrthogonal();
  frame.y = frame.middle.cross(frame.x);
  double largest = 0.0;
  for (const PlacedBeam& beam : beams) {
    if (!(beam.direction.dot(frame.middle) > kMinCosine)) return std::nullopt;
    largest = std::max(largest, frame.slopes(beam.direction).lpNorm<Eigen::Infinity>());
  }
  if (!(largest > 0.0)) return std::nullopt;
  frame.scale = largest;
  return frame;
}

/// Coefficients of column (1 + g s + h t) = a s + b t + c and row (1 + g s + h t) = d s + e t + f,
/// for the slopes s and t: in the order a to h. Affine: g and h are zero.
std::optional<Unknowns> solve(std::span<const PlacedBeam> beams, const MiddleFrame& frame,
                              const Interval& columns, const Interval& rows, bool is_affine) {
  NormalMatrix normal = NormalMatrix::Zero();
  Unknowns right = Unknowns::Zero();
  for (const PlacedBeam& beam : beams) {
    const Eigen::Vector2d s = frame.slopes(beam.direction);
    const double column = columns(beam.column);
    const double row = rows(beam.row);
    Unknowns of_column;
    of_column << s.x(), s.y(), 1.0, 0.0, 0.0, 0.0, -column * s.x(), -column * s.y();
    Unknowns of_row;
    of_row << 0.0, 0.0, 0.0, s.x(), s.y(), 1.0, -row * s.x(), -row * s.y();
    if (is_affine) of_column.tail<2>().setZero();
    if (is_affine) of_row.tail<2>().setZero();
    normal += of_column * of_column.transpose() + of_row * of_row.transpose();
    right += column * of_column + row * of_row;
  }
  if (is_affine) normal.diagonal().tail<2>().setConstant(static_cast<double>(beams.size()));
  const Eigen::LDLT<NormalMatrix> factors(normal);
  const Unknowns pivots = factors.vectorD();
  if (!(pivots.minCoeff() > kMinPivot * pivots.maxCoeff())) return std::nullopt;
  return factors.solve(right);
}

Eigen::Matrix3d rows_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
  Eigen::Matrix3d rows;
  rows << a.transpose(), b.transpose(), c.transpose();
  return rows;
}

ProjectiveMap map_of(const Unknowns& k, const MiddleFrame& frame, const Interval& columns,
                     const Interval& rows) {
  // Slopes are zero in the middle, so the number of the middle column is subtracted.
  const Eigen::Vector3d forward = frame.middle + (k[6] * frame.x + k[7] * frame.y) / frame.scale;
  const Eigen::Vector3d side =
      ((k[0] - k[2] * k[6]) * frame.x + (k[1] - k[2] * k[7]) * frame.y) / frame.scale;
  const Eigen::Vector3d up =
      ((k[3] - k[5] * k[6]) * frame.x + (k[4] - k[5] * k[7]) * frame.y) / frame.scale;
  ProjectiveMap map;
  map.columns_per_slope = columns.half * side.norm() / forward.norm();
  map.middle_column = columns.middle + columns.half * k[2];
  map.rows_per_slope = rows.half * up.norm() / forward.norm();
  map.middle_row = rows.middle + rows.half * k[5];
  map.frame.slopes_from_sensor = rows_of(forward.normalized(), side.normalized(), up.normalized());
  const Eigen::Vector3d right = side.normalized();
  const Eigen::Vector3d across = frame.middle.cross(right);
  map.frame.sector_from_sensor =
      rows_of(frame.middle, right, across.dot(up) < 0.0 ? Eigen::Vector3d(-across) : across);
  return map;
}

}  // namespace

std::optional<ProjectiveMap> fit_projective_map(std::span<const PlacedBeam> beams) {
  if (beams.size() < kMinBeams) return std::nullopt;
  const std::optional<MiddleFrame> frame = find_middle(beams);
  if (!frame) return std::nullopt;
  const Interval columns(beams, &PlacedBeam::column);
  const Interval rows(beams, &PlacedBeam::row);
  std::optional<Unknowns> solution = solve(beams, *frame, columns, rows, false);
  if (solution && !(solution->tail<2>().norm() <= kMaxTilt * frame->scale)) {
    solution = solve(beams, *frame, columns, rows, true);
  }
  if (!solution) return std::nullopt;
  const ProjectiveMap map = map_of(*solution, *frame, columns, rows);
  const auto is_of_use = [](double per_slope) {
    return per_slope > 0.0 && per_slope <= kMaxPerSlope;
  };
  const bool is_map = is_of_use(map.columns_per_slope) && is_of_use(map.rows_per_slope) &&
                      map.frame.slopes_from_sensor.allFinite();
  return is_map ? std::optional(map) : std::nullopt;
}

}  // namespace glidar::scan_raster
