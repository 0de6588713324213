// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/recorded_source.hpp>

#include <apps/glidar/run/placed_motion.hpp>
#include <glidar/core/error.hpp>

#include <algorithm>
#include <utility>

namespace glidar::app {
namespace {

using Clock = std::chrono::steady_clock;

void check(const link::RecordedFrame& frame, std::uint64_t number, const PreparedScene& prepared) {
  const std::size_t objects = frame.moment.objects.size();
  const std::size_t instances = prepared.scene.instances.size();
  const bool fits = frame.sensor < prepared.sensors.size() &&
                    (!frame.is_placed || objects == 0 || objects == instances);
  if (fits) return;
  throw Error(
      {"recording, frame " + std::to_string(number),
       "sensor " + std::to_string(frame.sensor) + " and " + std::to_string(objects) + " objects",
       std::to_string(prepared.sensors.size()) + " sensors and " + std::to_string(instances) +
           " objects, which the scene has",
       "replay it with the scene that it was recorded with"});
}

}  // namespace

RecordedSource::RecordedSource(link::RecordingReader& recording, const Options& options,
                               const PreparedScene& prepared, const StopRequest& stop)
    : recording_(recording),
      options_(options),
      prepared_(prepared),
      stop_(stop),
      next_indices_(prepared.sensors.size()) {}

/// The next frame; empty at the end, of which `ending_` states why.
std::optional<link::RecordedFrame> RecordedSource::read() {
  if (number_ >= options_.schedule.frames) {
    ending_ = "all frames are done";
    return std::nullopt;
  }
  std::optional<link::RecordedFrame> frame = recording_.next();
  if (!frame) ending_ = "the recording is complete";
  return frame;
}

std::optional<FrameRequest> RecordedSource::next() {
  std::optional<link::RecordedFrame> frame = read();
  if (!frame && options_.playback != nullptr) {
    while (!stop_.is_requested()) stop_.wait_until(Clock::now() + std::chrono::hours(1));
  }
  if (!frame) return std::nullopt;
  check(*frame, number_, prepared_);
  if (options_.playback != nullptr && !options_.playback->wait(stop_)) return std::nullopt;
  wait_until_due(frame->moment.t_ns);
  if (stop_.is_requested()) return std::nullopt;
  ++number_;
  FrameRequest moment{.sensor_index = frame->sensor,
                      .number = frame->moment.number,
                      .index = next_indices_[frame->sensor]++,
                      .due = *due_,
                      .motion = {},
                      .stamp_ns = frame->moment.t_ns,
                      .seed = frame->moment.seed,
                      .frame_hash = std::move(frame->frame_hash)};
  if (frame->is_placed) moment.motion = motion_at(frame->moment, prepared_);
  return moment;
}

/// From the last frame to this one.
std::chrono::duration<double> RecordedSource::period(std::int64_t t_ns) const {
  constexpr double kNanosecond_s = 1e-9;
  constexpr double kMax_s = 10.0;  // clients may give any time
  if (options_.pace == ReplayPace::stamps) {
    const double s = kNanosecond_s * (static_cast<double>(t_ns) - static_cast<double>(last_ns_));
    return std::chrono::duration<double>(std::clamp(s, 0.0, kMax_s));
  }
  const double rate_hz = options_.schedule.rate_hz;
  return std::chrono::duration<double>(rate_hz > 0.0 ? 1.0 / rate_hz : 0.0);
}

void RecordedSource::wait_until_due(std::int64_t t_ns) {
  const Clock::time_point now = Clock::now();
  const auto since_last = std::chrono::duration_cast<Clock::duration>(period(t_ns));
  last_ns_ = t_ns;
  due_ = due_ ? std::max(now, *due_ + since_last) : now;
  while (Clock::now() < *due_ && !stop_.is_requested()) stop_.wait_until(*due_);
}

}  // namespace glidar::app
