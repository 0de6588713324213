// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/field.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

namespace glidar {

class FieldVisitor;

/// A beam that mirrors steer along lines, scan after scan: elevations x azimuths, or azimuths x
/// elevations if the lines are vertical (terrestrial scanners, whose head turns from line to line).
/// A 2D scanner has one line. Azimuths are from +x towards +y, elevations towards +z.
struct LineScan {
  static constexpr TypeInfo kType = {"line_scan", "a scanner that measures lines of points"};
  enum class Lines : std::uint8_t { horizontal, vertical };
  Lines lines = Lines::horizontal;
  /// Of the lines in time order, one row each, and of the points of a line in time order; the other
  /// way round if the lines are vertical.
  std::vector<double> elevations_rad = {0.0};
  std::vector<double> azimuths_rad;
  double point_ns = 0.0;       ///< time between points
  double line_ns = 0.0;        ///< time between lines
  bool bidirectional = false;  ///< every second line is scanned backwards
  double scan_hz = 10.0;       ///< scans per second; a scan begins at time 0
};

/// Keys of `optics` in sensor files.
void describe(LineScan& scan, FieldVisitor& visitor);

/// rows x cols if the interval is exactly one scan; else the firings in the interval in time order,
/// as one row. Frame lidar_frame (x forward, y left, z up), boresight +x.
/// Throws Error if a number is out of range or a scan is longer than its period.
Beams make_beams(const LineScan& raster, const FrameInterval& interval);

}  // namespace glidar
