// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/laser_scan.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

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
std::vector<ScanBeam> beams_of(const Beams& beams, std::uint16_t ring, int quarter_turns) {
  SensorAxes axes = axes_of(beams);
  for (int i = 0; i < quarter_turns; ++i)
    axes = {.ahead = -axes.left, .left = axes.ahead, .up = axes.up};
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
    throw Error(
        {where, fmt::format("beams {:.6g} and {:.6g} rad apart", angle, spacing),
         "equal angles between neighbours",
         "let the frame start at an end of the sector (start_azimuth_deg), or publish a cloud"});
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
      return static_cast<float>(portable_hypot(point.dot(axes.ahead), point.dot(axes.left)));
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

/// From -pi to below pi; an angle within `tolerance` below it is -pi.
double wrapped(double angle_rad, double tolerance) {
  const double turns = std::floor((angle_rad + std::numbers::pi + tolerance) / kWholeTurn);
  return angle_rad - kWholeTurn * turns;
}

/// Angles that increase, from -pi on if they are a whole turn.
void sort_by_angle(double spacing, std::vector<ScanBeam>& scan) {
  if (scan.back().angle_rad < scan.front().angle_rad) std::reverse(scan.begin(), scan.end());
  constexpr double kTolerance = 1e-3;
  const double covered = spacing * static_cast<double>(scan.size());
  const bool is_whole_turn = std::abs(covered - kWholeTurn) < spacing;
  if (!is_whole_turn) {
    const double shift = wrapped(scan.front().angle_rad, 0.0) - scan.front().angle_rad;
    for (ScanBeam& beam : scan) beam.angle_rad += shift;
    return;
  }
  for (ScanBeam& beam : scan) beam.angle_rad = wrapped(beam.angle_rad, kTolerance * spacing);
  std::sort(scan.begin(), scan.end(),
            [](const ScanBeam& a, const ScanBeam& b) { return a.angle_rad < b.angle_rad; });
}

LaserScan empty_scan(const CloudSource& source, std::int64_t stamp_ns,
                     const std::string& frame_id) {
  LaserScan message;
  message.header = {.stamp = time_from_ns(stamp_ns),
                    .frame_id = frame_id.empty() ? source.frame.frame_id : frame_id};
  message.scan_time = static_cast<float>(1.0 / source.sensor.rate_hz);
  return message;
}

void set_angles(double min_rad, double max_rad, double increment_rad, LaserScan& message) {
  message.angle_min = static_cast<float>(min_rad);
  message.angle_max = static_cast<float>(max_rad);
  message.angle_increment = static_cast<float>(increment_rad);
}

void fill(std::size_t size, float range, LaserScan& message) {
  message.ranges.assign(size, range);
  message.intensities.assign(size, 0.0F);
}

/// Beams with a return, their level range and their azimuth from -pi to pi.
template <class Use>
void for_returns(const CloudSource& source, std::optional<std::uint16_t> ring, const Use& use) {
  const Beams& beams = source.beams;
  const SensorAxes axes = axes_of(beams);
  for (std::size_t i = 0; i < beams.firings(); ++i) {
    if (source.frame.status[i] != Status::hit || (ring && ring_of(beams, i) != *ring)) continue;
    use(i, range_of(source, i), azimuth_rad(axes, beams.directions[i]));
  }
}

}  // namespace

LaserScan velodyne_scan(const CloudSource& source, std::int64_t stamp_ns,
                        const std::string& frame_id) {
  constexpr double kResolution_rad = 0.007;
  const Beams& beams = source.beams;
  std::uint16_t rings = 0;
  for (std::size_t i = 0; i < beams.firings(); ++i)
    rings = std::max<std::uint16_t>(rings, static_cast<std::uint16_t>(ring_of(beams, i) + 1));
  const std::uint16_t level = rings > 32 ? 57 : rings > 16 ? 23 : 8;
  LaserScan message = empty_scan(source, stamp_ns, frame_id);
  message.scan_time = 0.0F;
  set_angles(-std::numbers::pi, std::numbers::pi, kResolution_rad, message);
  message.range_max = 200.0F;
  const auto size = static_cast<std::size_t>(kWholeTurn / kResolution_rad);
  fill(size, std::numeric_limits<float>::infinity(), message);
  for_returns(source, level, [&](std::size_t beam, float range_m, double angle_rad) {
    const auto bin = static_cast<std::size_t>((angle_rad + std::numbers::pi) / kResolution_rad);
    if (bin >= size) return;
    message.ranges[bin] = range_m;
    message.intensities[bin] = source.frame.intensity[beam];
  });
  return message;
}

LaserScan ouster_scan(const CloudSource& source, std::int64_t stamp_ns,
                      const std::string& frame_id) {
  const Beams& beams = source.beams;
  const std::size_t width = beams.cols;
  const std::size_t shift = row_shifts(source.sensor, beams)[0];
  LaserScan message = empty_scan(source, stamp_ns, frame_id);
  set_angles(-std::numbers::pi, std::numbers::pi, kWholeTurn / static_cast<double>(width), message);
  message.time_increment = message.scan_time / static_cast<float>(width);
  message.range_min = 0.1F;
  message.range_max = 120.0F;
  fill(width, 0.0F, message);
  for (std::size_t v = 0; v < width; ++v) {
    const std::size_t beam = (v + width - shift + width / 2) % width;
    if (source.frame.status[beam] != Status::hit) continue;
    const double millimetres =
        std::round((source.frame.range_m[beam] + beams.range_offset_m) * 1e3);
    message.ranges[width - 1 - v] = static_cast<float>(millimetres * 1e-3);
    message.intensities[width - 1 - v] = source.frame.intensity[beam];
  }
  return message;
}

LaserScan rplidar_scan(const CloudSource& source, std::int64_t stamp_ns,
                       const std::string& frame_id) {
  constexpr double kTurn_deg = 360.0;
  const std::size_t per_degree = source.beams.cols / 360 + 1;
  const std::size_t size = 360 * per_degree;
  LaserScan message = empty_scan(source, stamp_ns, frame_id);
  const auto steps = static_cast<double>(size - 1);
  set_angles(-std::numbers::pi, std::numbers::pi, kWholeTurn / steps, message);
  message.time_increment = message.scan_time / static_cast<float>(steps);
  message.range_min = 0.05F;
  message.range_max = static_cast<float>(source.sensor.limits.far_m);
  fill(size, std::numeric_limits<float>::infinity(), message);
  for_returns(source, std::nullopt, [&](std::size_t beam, float range_m, double angle_rad) {
    // clockwise from the zero of the device
    const double clockwise_deg = angle_rad > 0.0 ? kTurn_deg * (1.0 - angle_rad / kWholeTurn)
                                                 : -kTurn_deg * angle_rad / kWholeTurn;
    const auto bin = static_cast<std::size_t>(clockwise_deg * static_cast<double>(per_degree));
    const float share = std::clamp(source.frame.intensity[beam], 0.0F, 1.0F);
    for (std::size_t i = 0; i < per_degree; ++i) {
      const std::size_t reversed = size - 1 - std::min(bin + i, size - 1);
      message.ranges[reversed] = range_m;
      message.intensities[reversed] = std::floor(255.0F * share / 4.0F);
    }
  });
  return message;
}

LaserScan laser_scan(const CloudSource& source, std::uint16_t ring, const std::string& frame_id,
                     int quarter_turns) {
  std::vector<ScanBeam> scan = beams_of(source.beams, ring, quarter_turns);
  const double spacing = std::abs(spacing_of(scan, ring));
  const auto steps = static_cast<double>(scan.size() - 1);
  const std::uint32_t first_ns = time_of(source.beams, scan.front().index);
  const std::uint32_t last_ns = time_of(source.beams, scan.back().index);
  sort_by_angle(spacing, scan);
  LaserScan message = empty_scan(source, source.frame.stamp_ns + first_ns, frame_id);
  const double angle_min = scan.front().angle_rad;
  set_angles(angle_min, angle_min + spacing * steps, spacing, message);
  message.time_increment =
      static_cast<float>(1e-9 * static_cast<double>(last_ns - first_ns) / steps);
  message.range_min = static_cast<float>(source.sensor.limits.near_m);
  message.range_max = static_cast<float>(source.sensor.limits.far_m);
  for (const ScanBeam& beam : scan) {
    message.ranges.push_back(range_of(source, beam.index));
    message.intensities.push_back(source.frame.intensity[beam.index]);
  }
  return message;
}

}  // namespace glidar::ros
