// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/optics/firing_schedule.hpp>

namespace glidar {

/// A beam that mirrors lead along lines, scan after scan: elevations x azimuths. One line is a 2D
/// scanner. Azimuths count from +x to the left, elevations from the horizon upwards.
struct LineScan {
  std::vector<double> elevations_rad;  ///< of the lines, in the order of time; they are the rows
  std::vector<double> azimuths_rad;    ///< of the points of a line, in the order of time
  double point_ns = 0.0;               ///< from point to point
  double line_ns = 0.0;                ///< from line to line
  bool bidirectional = false;          ///< every second line is scanned from its end
  double scan_hz = 10.0;               ///< scans per second; a scan begins at time 0
};

/// rows x cols when the window is exactly one scan; else the shots in the window in the order of
/// time, as one row. Frame lidar_frame, boresight +x.
/// Throws Error when a number is out of range or a scan lasts longer than its period.
Beams make_beams(const LineScan& raster, const FrameInterval& window);

}  // namespace glidar
