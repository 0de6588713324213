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

/// A central projection without distortion: the ray of pixel (u, v) has the direction
/// ((u + pixel_centre - cx) / fx, (v + pixel_centre - cy) / fy, 1) in the optical frame
/// (x right, y down, z forward).
struct PinholeIntrinsics {
  std::uint32_t width = 0;    ///< pixels
  std::uint32_t height = 0;   ///< pixels
  double fx = 0.0;            ///< pixels
  double fy = 0.0;            ///< pixels
  double cx = 0.0;            ///< pixels
  double cy = 0.0;            ///< pixels
  double pixel_centre = 0.5;  ///< coordinate of a pixel's centre: 0.5 (graphics) or 0 (OpenCV, ROS)
};

/// The unit direction through the point (x, y) of the plane z = 1. The order of the operations is
/// part of the contract: code that recomputes directions gets the same bits.
inline Eigen::Vector3d direction_through(double x, double y) {
  const double length = std::sqrt(x * x + y * y + 1.0);
  return {x / length, y / length, 1.0 / length};
}

/// Coordinates at which the rays of column u and of row v cross the plane z = 1.
inline double plane_x(const PinholeIntrinsics& k, std::uint32_t u) {
  return (u + k.pixel_centre - k.cx) / k.fx;
}
inline double plane_y(const PinholeIntrinsics& k, std::uint32_t v) {
  return (v + k.pixel_centre - k.cy) / k.fy;
}

/// The rays that a sensor emits, in the sensor frame: one straight beam per entry, row-major.
/// N = rows * cols. Origins in metres.
struct Beams {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;                     ///< name of the sensor's frame
  std::vector<Eigen::Vector3d> directions;  ///< N unit vectors; NaN where there is no beam
  std::vector<Eigen::Vector3d> origins_m;   ///< N; empty: all zero
  std::vector<std::uint32_t> times_ns;      ///< N, since the start of the frame; empty: all zero
  std::vector<std::uint16_t> rings;         ///< N, channel number; empty: the row
  /// Returns that the sensor reports per pulse. Every beam is repeated once per return: the rows of
  /// the first return, then the same rows for the second, and so on.
  std::uint32_t returns = 1;
  /// Added to the distance from a beam's origin in reported ranges, because some sensors measure
  /// from another point (Ouster: the axis of rotation).
  double range_offset_m = 0.0;
  Eigen::Vector3d boresight =
      Eigen::Vector3d::UnitZ();  ///< unit vector; depth is measured along it
  /// Set for an undistorted pinhole camera: directions[v * width + u] is then bit-identical to
  /// direction_through(plane_x(u), plane_y(v)).
  std::optional<PinholeIntrinsics> pinhole;

  [[nodiscard]] std::size_t size() const { return directions.size(); }
  [[nodiscard]] std::size_t firings() const { return directions.size() / returns; }
};

/// Unit axes of a sensor frame.
struct SensorAxes {
  Eigen::Vector3d ahead;
  Eigen::Vector3d left;
  Eigen::Vector3d up;
};

/// True for cameras, whose optical frame has the boresight +z and y down (REP-103). All other
/// sensors have the boresight +x and z up.
bool looks_along_z(const Beams& beams);
SensorAxes axes_of(const Beams& beams);

/// Azimuth of a direction, from ahead towards the left, -pi to pi, and its elevation above the
/// plane of ahead and left, -pi/2 to pi/2.
double azimuth_rad(const SensorAxes& axes, const Eigen::Vector3d& direction);
double elevation_rad(const SensorAxes& axes, const Eigen::Vector3d& direction);

/// Depth of the point at this range on a beam, along the boresight from the sensor's origin.
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
