// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// A central projection without distortion: pixel (u, v) looks along
/// ((u + pixel_centre - cx) / fx, (v + pixel_centre - cy) / fy, 1) in the optical frame.
struct PinholeIntrinsics {
  std::uint32_t width = 0;    ///< pixels
  std::uint32_t height = 0;   ///< pixels
  double fx = 0.0;            ///< pixels
  double fy = 0.0;            ///< pixels
  double cx = 0.0;            ///< pixels
  double cy = 0.0;            ///< pixels
  double pixel_centre = 0.5;  ///< where in a pixel its ray goes: 0.5 (graphics) or 0 (OpenCV, ROS)
};

/// The unit direction through the point (x, y) of the plane at depth 1. The order of its operations
/// is part of the promise: who works directions out anew gets the same bits.
inline Eigen::Vector3d direction_through(double x, double y) {
  const double length = std::sqrt(x * x + y * y + 1.0);
  return {x / length, y / length, 1.0 / length};
}

/// Where the rays of column u and of row v cross the plane at depth 1.
inline double plane_x(const PinholeIntrinsics& k, std::uint32_t u) {
  return (u + k.pixel_centre - k.cx) / k.fx;
}
inline double plane_y(const PinholeIntrinsics& k, std::uint32_t v) {
  return (v + k.pixel_centre - k.cy) / k.fy;
}

/// What a sensor emits, in its own frame: one straight beam per entry, rows x cols, row by row.
/// N = rows * cols.
struct Beams {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;                     ///< name of the sensor's frame
  std::vector<Eigen::Vector3d> directions;  ///< N unit vectors; NaN where there is no beam
  std::vector<Eigen::Vector3d> origins_m;   ///< N; empty: all zero
  std::vector<std::uint32_t> times_ns;      ///< N, since the start of the frame; empty: all zero
  std::vector<std::uint16_t> rings;         ///< N, channel number; empty: the row
  /// How many times every beam stands here, once for each return that its sensor tells of a pulse:
  /// the rows of the first return, then the same rows for the second, ...
  std::uint32_t returns = 1;
  /// Added to the distance from a beam's origin when its range is reported: some sensors count from
  /// elsewhere (Ouster: from the axis of rotation).
  double range_offset_m = 0.0;
  Eigen::Vector3d boresight = Eigen::Vector3d::UnitZ();  ///< depth is measured along it
  /// The structure the beams were made from, if it is this one: then directions[v * width + u] is
  /// direction_through(plane_x(u), plane_y(v)), bit for bit.
  std::optional<PinholeIntrinsics> pinhole;

  [[nodiscard]] std::size_t size() const { return directions.size(); }
  [[nodiscard]] std::size_t firings() const { return directions.size() / returns; }
};

/// Axes of a sensor's frame.
struct SensorAxes {
  Eigen::Vector3d ahead;
  Eigen::Vector3d left;
  Eigen::Vector3d up;
};

/// Cameras look along +z with y down (REP-103), all others along +x with z up.
bool looks_along_z(const Beams& beams);
SensorAxes axes_of(const Beams& beams);

/// Angles of a direction: to the left from ahead, -pi to pi, and up from the level, -pi/2 to pi/2.
double azimuth_rad(const SensorAxes& axes, const Eigen::Vector3d& direction);
double elevation_rad(const SensorAxes& axes, const Eigen::Vector3d& direction);

/// Depth of a point at a range on a beam: along the boresight, from the sensor's origin.
inline double depth_m(const Beams& beams, std::size_t beam, double range_m) {
  const double along_beam = range_m * beams.directions[beam].dot(beams.boresight);
  return beams.origins_m.empty() ? along_beam
                                 : along_beam + beams.origins_m[beam].dot(beams.boresight);
}

/// The channel of a beam.
inline std::uint16_t ring_of(const Beams& beams, std::size_t beam) {
  return beams.rings.empty() ? static_cast<std::uint16_t>(beam / beams.cols) : beams.rings[beam];
}

/// Throws Error unless every array has its stated size and every direction is a unit vector or NaN.
void validate(const Beams& beams);

}  // namespace glidar
