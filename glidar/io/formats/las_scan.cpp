// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/las_scan.hpp>

#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace glidar {
namespace {

constexpr int kStepsPerTurn = 60'000;
constexpr std::uint8_t kScanDirection = 1U << 6U;
constexpr std::uint8_t kEdge = 1U << 7U;

std::uint32_t fired_after(const Beams& beams, std::size_t entry) {
  return beams.times_ns.empty() ? 0U : beams.times_ns[entry];
}

/// The way of the sensor's origin from the first to the last beam, in the sensor frame; 0 if it
/// rests.
Eigen::Vector3d sensor_shift(const Frame& frame, const Beams& beams) {
  const std::vector<Eigen::Vector3d>& moved = frame.deskewed.origins_m;
  if (moved.empty() || beams.times_ns.empty()) return Eigen::Vector3d::Zero();
  const auto [first, last] = std::ranges::minmax_element(beams.times_ns);
  const auto shift = [&](auto time) {
    const auto beam = static_cast<std::size_t>(time - beams.times_ns.begin());
    const bool is_central = beams.origins_m.empty();
    return is_central ? moved[beam] : Eigen::Vector3d(moved[beam] - beams.origins_m[beam]);
  };
  return shift(last) - shift(first);
}

Eigen::Vector3d level_part(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), 0.0};
}

/// The horizontal direction of flight in the cloud's frame, a unit vector.
Eigen::Vector3d flight_direction(const Frame& frame, const Beams& beams,
                                 const Eigen::Matrix3d& cloud_from_sensor) {
  constexpr double kRest_m = 1e-6;
  const Eigen::Vector3d motion = level_part(cloud_from_sensor * sensor_shift(frame, beams));
  if (motion.norm() > kRest_m) return motion.normalized();
  const SensorAxes axes = axes_of(beams);
  const Eigen::Vector3d ahead = cloud_from_sensor * axes.ahead;
  if (level_part(ahead).norm() > 0.5) return level_part(ahead).normalized();
  // the sensor looks down or up, so its upper side is ahead or behind
  const Eigen::Vector3d up = level_part(cloud_from_sensor * axes.up).normalized();
  return ahead.z() < 0.0 ? up : Eigen::Vector3d(-up);
}

/// Sets the flags of the points of a scan line, in time order. The angle turns towards the next
/// point as from the one before.
void set_line_flags(std::span<const std::uint32_t> points, LasScan& scan) {
  std::size_t known = 0;  // points whose direction is known
  for (std::size_t k = 1; k < points.size(); ++k) {
    const int turned = scan.angles[points[k]] - scan.angles[points[k - 1]];
    const bool is_right = (turned > 0) == (std::abs(turned) < kStepsPerTurn / 2);
    if (turned == 0 && known == 0) continue;
    const std::uint8_t flag = turned == 0 ? scan.flags[points[k - 1]]
                              : is_right  ? kScanDirection
                                          : std::uint8_t{0};
    for (; known <= k; ++known) scan.flags[points[known]] = flag;
  }
}

void set_scan_flags(const Beams& beams, std::span<const std::uint32_t> order, LasScan& scan) {
  std::vector<std::vector<std::uint32_t>> lines(beams.firings() / beams.cols);
  const auto pulse = [&](std::size_t point) { return order[point] % beams.firings(); };
  for (std::uint32_t point = 0; point < order.size(); ++point)
    lines[pulse(point) / beams.cols].push_back(point);
  for (const std::vector<std::uint32_t>& points : lines) {
    set_line_flags(points, scan);
    for (std::size_t k = points.size(); k-- > 0 && pulse(points[k]) == pulse(points.back());)
      scan.flags[points[k]] |= kEdge;
  }
}

}  // namespace

std::vector<std::uint32_t> las_order(const Frame& frame, const Beams& beams) {
  std::vector<std::uint32_t> order;
  const std::size_t size = frame.status.size();
  if (beams.size() != size || frame.range_m.size() != size) return order;
  for (std::size_t i = 0; i < size; ++i) {
    if (frame.status[i] == Status::hit) order.push_back(static_cast<std::uint32_t>(i));
  }
  const std::size_t firings = beams.firings();
  const auto key = [&](std::uint32_t i) {
    return std::tuple(fired_after(beams, i), i % firings, frame.range_m[i]);
  };
  std::ranges::stable_sort(order, {}, key);
  return order;
}

LasScan las_scan(const Frame& frame, const Beams& beams, const Sensor& sensor,
                 const Pose& world_from_cloud, std::span<const std::uint32_t> order) {
  const Eigen::Matrix3d cloud_from_sensor =
      world_from_cloud.linear().transpose() * frame.world_from_sensor.linear();
  const Eigen::Vector3d right =
      flight_direction(frame, beams, cloud_from_sensor).cross(Eigen::Vector3d::UnitZ());
  const bool is_moving = !frame.deskewed.directions.empty();
  LasScan scan;
  scan.angles.reserve(order.size());
  scan.flags.assign(order.size(), 0);
  for (const std::uint32_t entry : order) {
    const Eigen::Vector3d& fired =
        is_moving ? frame.deskewed.directions[entry] : beams.directions[entry];
    const Eigen::Vector3d beam = cloud_from_sensor * fired;
    double turns = atan2_turns(beam.dot(right), -beam.z());  // from 0 to 1
    if (turns > 0.5) turns -= 1.0;
    scan.angles.push_back(static_cast<std::int16_t>(std::lround(turns * kStepsPerTurn)));
  }
  const bool has_lines = std::holds_alternative<LineScan>(sensor.optics) ||
                         std::holds_alternative<Spinning>(sensor.optics);
  if (has_lines && !order.empty()) set_scan_flags(beams, order, scan);
  return scan;
}

}  // namespace glidar
