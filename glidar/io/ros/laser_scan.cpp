// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/laser_scan.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar::ros {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// A beam of the scan.
struct ScanBeam {
  std::size_t index = 0;
  double angle_rad = 0.0;  ///< continuous: without a jump at +-pi
};

std::uint32_t time_of(const Beams& beams, std::size_t beam) {
  return beams.times_ns.empty() ? 0 : beams.times_ns[beam];
}

/// The beams of a ring in the order in which they fire.
std::vector<ScanBeam> beams_of(const Beams& beams, std::uint16_t ring) {
  const SensorAxes axes = axes_of(beams);
  std::vector<ScanBeam> scan;
  for (std::size_t i = 0; i < beams.firings(); ++i) {
    if (ring_of(beams, i) != ring || std::isnan(beams.directions[i].x())) continue;
    scan.push_back({i, azimuth_rad(axes, beams.directions[i])});
  }
  std::stable_sort(scan.begin(), scan.end(), [&](const ScanBeam& a, const ScanBeam& b) {
    return time_of(beams, a.index) < time_of(beams, b.index);
  });
  for (std::size_t i = 1; i < scan.size(); ++i) {
    const double change = scan[i].angle_rad - scan[i - 1].angle_rad;
    scan[i].angle_rad -= kWholeTurn * std::round(change / kWholeTurn);
  }
  return scan;
}

/// The angle between neighbours. Throws Error unless all are equal to a hundredth.
double spacing_of(const std::vector<ScanBeam>& scan, std::uint16_t ring) {
  const std::string where = fmt::format("LaserScan of ring {}", ring);
  if (scan.size() < 2) {
    throw Error({where, fmt::format("{} beams", scan.size()), "at least 2",
                 "select another ring, or publish a cloud"});
  }
  const double spacing =
      (scan.back().angle_rad - scan.front().angle_rad) / static_cast<double>(scan.size() - 1);
  constexpr double kTolerance = 0.01;
  for (std::size_t i = 1; i < scan.size(); ++i) {
    const double angle = scan[i].angle_rad - scan[i - 1].angle_rad;
    if (std::abs(angle - spacing) <= kTolerance * std::abs(spacing)) continue;
    throw Error({where, fmt::format("beams {:.6g} and {:.6g} rad apart", angle, spacing),
                 "equal angles between neighbours", "publish a cloud instead"});
  }
  return spacing;
}

float range_of(const CloudSource& source, std::size_t beam) {
  switch (source.frame.status[beam]) {
    case Status::hit: {
      const Beams& beams = source.beams;
      const SensorAxes axes = axes_of(beams);
      Eigen::Vector3d point = source.frame.range_m[beam] * beams.directions[beam];
      if (!beams.origins_m.empty()) point += beams.origins_m[beam];
      return static_cast<float>(std::hypot(point.dot(axes.ahead), point.dot(axes.left)));
    }
    case Status::too_near:
      return -std::numeric_limits<float>::infinity();
    case Status::miss:
    case Status::too_far:
    case Status::below_threshold:
    case Status::no_return_of_rank:
      return std::numeric_limits<float>::infinity();
    default:
      return kNaNf;
  }
}

/// From -pi to pi.
double wrapped(double angle_rad) {
  return angle_rad - kWholeTurn * std::round(angle_rad / kWholeTurn);
}

}  // namespace

LaserScan laser_scan(const CloudSource& source, std::uint16_t ring, const std::string& frame_id) {
  const Beams& beams = source.beams;
  std::vector<ScanBeam> scan = beams_of(beams, ring);
  const double spacing = std::abs(spacing_of(scan, ring));
  if (scan.back().angle_rad < scan.front().angle_rad) std::reverse(scan.begin(), scan.end());
  const double steps = static_cast<double>(scan.size() - 1);
  const double first_ns = time_of(beams, scan.front().index);
  const double last_ns = time_of(beams, scan.back().index);
  LaserScan message;
  message.header = {.stamp = time_from_ns(source.frame.stamp_ns +
                                          std::int64_t{time_of(beams, scan.front().index)}),
                    .frame_id = frame_id.empty() ? source.frame.frame_id : frame_id};
  const double angle_min = wrapped(scan.front().angle_rad);
  message.angle_min = static_cast<float>(angle_min);
  message.angle_max = static_cast<float>(angle_min + spacing * steps);
  message.angle_increment = static_cast<float>(spacing);
  message.time_increment = static_cast<float>((last_ns - first_ns) * 1e-9 / steps);
  message.scan_time = static_cast<float>(1.0 / source.sensor.rate_hz);
  message.range_min = static_cast<float>(source.sensor.limits.near_m);
  message.range_max = static_cast<float>(source.sensor.limits.far_m);
  for (const ScanBeam& beam : scan) {
    message.ranges.push_back(range_of(source, beam.index));
    message.intensities.push_back(source.frame.intensity[beam.index]);
  }
  return message;
}

}  // namespace glidar::ros
