// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/line_scan.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/ray_table.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool is_vertical(const LineScan& scan) {
  return scan.lines == LineScan::Lines::vertical;
}

std::size_t line_count(const LineScan& scan) {
  return is_vertical(scan) ? scan.azimuths_rad.size() : scan.elevations_rad.size();
}

std::size_t point_count(const LineScan& scan) {
  return is_vertical(scan) ? scan.elevations_rad.size() : scan.azimuths_rad.size();
}

Eigen::Vector3d direction_of(const LineScan& scan, std::size_t line, std::size_t point) {
  return is_vertical(scan) ? direction_at(scan.azimuths_rad[line], scan.elevations_rad[point])
                           : direction_at(scan.azimuths_rad[point], scan.elevations_rad[line]);
}

void validate(const LineScan& r) {
  const std::size_t lines = line_count(r);
  const std::size_t points = point_count(r);
  require_number(lines >= 1 && lines <= kMaxBeams, "optics, number of lines",
                 static_cast<double>(lines), "at least 1");
  require_number(points >= 1 && points <= kMaxBeams / lines, "optics, number of points in a line",
                 static_cast<double>(points), "at least 1, 134217728 beams in all");
  require_number(all_finite(r.elevations_rad) && all_finite(r.azimuths_rad), "optics, angles", 0.0,
                 "finite angles");
  require_number(r.scan_hz > 0.0 && std::isfinite(r.scan_hz), "optics, scans per second", r.scan_hz,
                 "above 0");
  const double line_lasts_ns = static_cast<double>(points - 1) * r.point_ns;
  require_number(r.point_ns >= 0.0 && (lines == 1 || r.line_ns >= line_lasts_ns),
                 "optics, time of a line", r.line_ns, "at least that of its points");
}

/// The pattern in time order.
RayTable in_time_order(const LineScan& r) {
  RayTable table;
  table.rows = static_cast<std::uint32_t>(line_count(r));
  table.cols = static_cast<std::uint32_t>(point_count(r));
  table.period_ns = kSecond_ns / r.scan_hz;
  for (std::size_t line = 0; line < table.rows; ++line) {
    const bool backwards = r.bidirectional && line % 2 == 1;
    for (std::size_t point = 0; point < table.cols; ++point) {
      const std::size_t col = backwards ? table.cols - 1 - point : point;
      table.directions.push_back(direction_of(r, line, col));
      table.times_ns.push_back(static_cast<double>(line) * r.line_ns +
                               static_cast<double>(point) * r.point_ns);
    }
  }
  return table;
}

/// Reverses the lines that are scanned backwards, so that column 0 is first.
void reverse_lines(Beams& beams) {
  for (std::size_t line = 1; line < beams.rows; line += 2) {
    const auto first = static_cast<std::ptrdiff_t>(line * beams.cols);
    const auto last = first + static_cast<std::ptrdiff_t>(beams.cols);
    std::reverse(beams.directions.begin() + first, beams.directions.begin() + last);
    std::reverse(beams.times_ns.begin() + first, beams.times_ns.begin() + last);
  }
}

}  // namespace

Beams make_beams(const LineScan& raster, const FrameInterval& interval) {
  validate(raster);
  Beams beams = make_beams(in_time_order(raster), interval);
  const bool grid = beams.rows == line_count(raster);
  if (grid && raster.bidirectional) reverse_lines(beams);
  return beams;
}

void describe(LineScan& scan, FieldVisitor& visitor) {
  constexpr std::size_t kMaxAngles = 65536;
  constexpr NumberRule kAzimuth = {-360.0, 360.0, false, "degrees from -360 to 360"};
  constexpr NumberRule kElevation = {-90.0, 90.0, false, "degrees from -90 to 90"};
  constexpr NumberRule kPointTime = {0.0, 1e6, false, "microseconds from 0 to 1e6"};
  if (visitor.is_report())
    visitor.number({"scan_hz", "scans per second", kUnitHertz}, kAboveZero, scan.scan_hz);
  using Lines = LineScan::Lines;
  constexpr std::array<Named<Lines>, 2> kLines = {
      {{"horizontal", Lines::horizontal}, {"vertical", Lines::vertical}}};
  visit_choice(visitor,
               {"lines", "`vertical`: lines along the elevation, one for each of `azimuth_deg`"},
               kLines, scan.lines);
  visitor.numbers(
      {"elevation_deg",
       "lines in the order of time: one number, a list, or `{from: , to: , count: }`", kUnitDegree},
      {.number = kElevation, .max_size = kMaxAngles, .takes_one = true, .takes_range = true},
      scan.elevations_rad);
  visitor.numbers(
      {"azimuth_deg", "points of a line in the order of time: a list, or `{from: , to: , count: }`",
       kUnitDegree, kRequired},
      {.number = kAzimuth, .max_size = kMaxAngles, .takes_one = true, .takes_range = true},
      scan.azimuths_rad);
  visitor.number({"point_us", "time between points", kUnitMicrosecond_ns}, kPointTime,
                 scan.point_ns);
  if (visitor.is_reading()) {
    // as if the file had the number, in its unit
    scan.line_ns =
        scan.point_ns * static_cast<double>(point_count(scan)) / kMicrosecond_ns * kMicrosecond_ns;
  }
  visitor.number({"line_us", "time between lines", kUnitMicrosecond_ns, false,
                  "`point_us` times the points of a line"},
                 kPointTime, scan.line_ns);
  visitor.boolean({"bidirectional", "`true`: every second line is scanned in reverse"},
                  scan.bidirectional);
}

}  // namespace glidar
