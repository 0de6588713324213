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

RecordedSource::RecordedSource(link::RecordingReader& recording, const FrameSchedule& schedule,
                               const PreparedScene& prepared, const StopRequest& stop)
    : recording_(recording),
      schedule_(schedule),
      prepared_(prepared),
      stop_(stop),
      next_indices_(prepared.sensors.size()) {}

std::optional<FrameRequest> RecordedSource::next() {
  if (number_ >= schedule_.frames) {
    ending_ = "all frames are done";
    return std::nullopt;
  }
  std::optional<link::RecordedFrame> frame = recording_.next();
  if (!frame) {
    ending_ = "the recording is complete";
    return std::nullopt;
  }
  check(*frame, number_, prepared_);
  wait_until_due();
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

void RecordedSource::wait_until_due() {
  const Clock::time_point now = Clock::now();
  if (!due_ || schedule_.rate_hz <= 0.0) {
    due_ = now;
    return;
  }
  const std::chrono::duration<double> period(1.0 / schedule_.rate_hz);
  due_ = std::max(now, *due_ + std::chrono::duration_cast<Clock::duration>(period));
  while (Clock::now() < *due_ && !stop_.is_requested()) stop_.wait_until(*due_);
}

}  // namespace glidar::app
