// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/sensor.hpp>
#include <support/preset.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace glidar::testing {

/// Start of the recordings, not at a full second or hour.
inline constexpr std::int64_t kPacketEpoch_ns = 1'700'001'234'567'891'000;

/// Distance from a point inside a room of 24 m x 16 m x 4.7 m to its walls.
inline double room_range_m(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d low(-12.0, -8.0, -1.2);
  const Eigen::Vector3d high(12.0, 8.0, 3.5);
  double range_m = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) continue;
    const double wall = direction[axis] > 0.0 ? high[axis] : low[axis];
    range_m = std::min(range_m, (wall - from[axis]) / direction[axis]);
  }
  return range_m;
}

/// A noise-free preset that reports one return, or the strongest and the last.
inline Sensor packet_sensor(const std::string& preset, bool is_dual) {
  Sensor sensor = noise_free_preset(preset);
  sensor.lidar_equation.reset();  // the intensity is the reflectivity, 0 to 1
  sensor.receiver.returns = {Return{}};
  if (!is_dual) return sensor;
  sensor.receiver.returns = {{Return::Order::strongest, 0}, {Return::Order::farthest, 0}};
  if (preset != "HDL-64E-S3") return sensor;
  auto& spinning = std::get<Spinning>(sensor.optics);  // it fires more slowly with two returns
  spinning.firing_period_ns = 57'600.0;
  for (std::size_t i = 0; i < spinning.channels.size(); ++i) {
    const double in_group[] = {0.0, 1300.0, 2500.0, 3700.0};
    spinning.channels[i].fire_time_ns = 7200.0 * static_cast<double>(i % 32 / 4) + in_group[i % 4];
  }
  return sensor;
}

/// Frame `number` of a sensor at rest in the room. Every seventh beam misses; every third has a
/// second return 1.5 m behind the first if the sensor reports two, and every sixth of these before.
/// An intensity i has the colour (i, 1 - i, i / 2).
inline DecodedFrame room_frame(const Sensor& sensor, std::uint32_t number) {
  DecodedFrame made;
  const FrameInterval interval = frame_interval(sensor, number);
  made.beams = make_beams(sensor, interval);
  const std::size_t size = made.beams.size();
  resize(made.frame, size);
  made.frame.ground_truth.colour.assign(size, Eigen::Vector3f(0.0F, 0.0F, 0.0F));
  made.frame.rows = made.beams.rows;
  made.frame.cols = made.beams.cols;
  made.frame.stamp_ns = kPacketEpoch_ns + interval.start_ns;
  made.frame.number = number;
  const std::size_t firings = made.beams.firings();
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t pulse = i % firings;
    const bool is_second = i >= firings;
    if (pulse % 7 == 3 || (is_second && pulse % 3 != 0)) {
      invalidate_return(made.frame, i, is_second ? Status::no_return_of_rank : Status::miss);
      continue;
    }
    const Eigen::Vector3d origin =
        made.beams.origins_m.empty() ? Eigen::Vector3d(0.0, 0.0, 0.0) : made.beams.origins_m[i];
    const double behind_m = is_second ? (pulse % 6 == 0 ? -0.5 : 1.5) : 0.0;
    made.frame.range_m[i] = room_range_m(origin, made.beams.directions[i]) + behind_m;
    made.frame.intensity[i] = static_cast<float>((pulse * 13 + 5) % 256) / 255.0F;
    made.frame.status[i] = Status::hit;
    const float share = made.frame.intensity[i];
    made.frame.ground_truth.colour[i] = {share, 1.0F - share, 0.5F * share};
  }
  return made;
}

/// One return, for comparisons apart from frames.
struct FlatReturn {
  std::int64_t stamp_ns = 0;
  std::uint16_t ring = 0;
  double range_m = 0.0;
  float intensity = 0.0F;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  Eigen::Vector3d xyz_m = Eigen::Vector3d::Zero();
};

/// All returns of a frame by ring, time and range.
inline void flatten(const DecodedFrame& from, std::vector<FlatReturn>& flat) {
  for (std::size_t i = 0; i < from.frame.range_m.size(); ++i) {
    if (from.frame.status[i] != Status::hit) continue;
    const Eigen::Vector3d origin =
        from.beams.origins_m.empty() ? Eigen::Vector3d(0.0, 0.0, 0.0) : from.beams.origins_m[i];
    const double range_m = from.frame.range_m[i];
    flat.push_back({from.frame.stamp_ns + from.beams.times_ns[i], from.beams.rings[i],
                    range_m + from.beams.range_offset_m, from.frame.intensity[i],
                    from.beams.directions[i], origin + range_m * from.beams.directions[i]});
  }
}

inline void sort_returns(std::vector<FlatReturn>& flat) {
  std::sort(flat.begin(), flat.end(), [](const FlatReturn& a, const FlatReturn& b) {
    if (a.ring != b.ring) return a.ring < b.ring;
    // the two returns of a pulse have the same time; pulses are further than 10 us apart
    if (std::abs(a.stamp_ns - b.stamp_ns) > 10'000) return a.stamp_ns < b.stamp_ns;
    return a.range_m < b.range_m;
  });
}

}  // namespace glidar::testing
