// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stream_sinks.hpp>

#include <apps/glidar/run/imu_sink.hpp>
#include <apps/glidar/run/recording_sinks.hpp>
#include <apps/glidar/run/udp_sink.hpp>

#include <algorithm>
#include <utility>

namespace glidar::app {

PoseOrigin pose_origin(const StreamFlags& flags) {
  return has_pose_source(flags) || flags.replays_requests ? PoseOrigin::frames : PoseOrigin::motion;
}

double time_speed(const StreamFlags& flags, const Sensor& first_sensor) {
  if (flags.replay.empty()) return has_pose_source(flags) || flags.is_unpaced ? 0.0 : 1.0;
  if (flags.replay_rate_hz) return *flags.replay_rate_hz / first_sensor.rate_hz;
  return flags.foxglove ? 1.0 : 0.0;
}

std::vector<std::unique_ptr<FrameSink>> make_stream_sinks(const StreamFlags& flags,
                                                          const PreparedScene& prepared,
                                                          const std::vector<std::string>& read,
                                                          link::ErrorLog& errors,
                                                          Console& console) {
  const PoseOrigin origin = pose_origin(flags);
  std::vector<std::unique_ptr<FrameSink>> sinks =
      make_recording_sinks(flags.render, prepared, read, origin);
  if (!flags.render.output.imu_paths.empty()) {
    sinks.push_back(make_imu_sink(flags.render, prepared, origin, console));
  }
  const double speed = time_speed(flags, prepared.sensors.front().sensor);
  for (auto& sink : make_udp_sinks(flags, speed, prepared, origin, {errors, console})) {
    sinks.push_back(std::move(sink));
  }
  return sinks;
}

std::chrono::milliseconds serve_interval(const std::vector<std::unique_ptr<FrameSink>>& sinks) {
  std::chrono::milliseconds interval = kDefaultServeInterval;
  for (const auto& sink : sinks) interval = std::min(interval, sink->serve_interval());
  return interval;
}

HitColumnMask needed_hit_columns(const std::vector<std::unique_ptr<FrameSink>>& sinks,
                                 std::size_t sensor_count) {
  HitColumnMask needed;
  for (const auto& sink : sinks) {
    for (std::size_t i = 0; i < sensor_count; ++i) {
      needed = needed | sink->hit_columns(i);
    }
  }
  return needed;
}

}  // namespace glidar::app
