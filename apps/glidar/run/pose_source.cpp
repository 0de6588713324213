// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/pose_source.hpp>

#include <apps/glidar/run/placement.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace glidar::app {

namespace {

using Clock = std::chrono::steady_clock;

Clock::duration seconds(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

/// How often the wait for a pose checks its time limit.
constexpr std::chrono::milliseconds kPosePollInterval{100};

}  // namespace

MotionSource::MotionSource(const FrameSchedule& schedule, std::vector<double> periods_s,
                           const StopRequest& stop)
    : schedule_(schedule),
      periods_s_(std::move(periods_s)),
      stop_(stop),
      numbers_(periods_s_.size()) {}

double MotionSource::start_s(std::size_t sensor_index) const {
  return static_cast<double>(numbers_[sensor_index]) * periods_s_[sensor_index];
}

bool MotionSource::is_done(std::size_t sensor_index) const {
  constexpr double kRounding = 1e-9;  // 0.3 s at 10 Hz are three frames
  return numbers_[sensor_index] >= schedule_.frames ||
         start_s(sensor_index) >= schedule_.duration_s - kRounding;
}

std::optional<FrameRequest> MotionSource::next() {
  std::optional<std::size_t> first;
  for (std::size_t sensor_index = 0; sensor_index < numbers_.size(); ++sensor_index) {
    if (is_done(sensor_index)) continue;
    if (!first || start_s(sensor_index) < start_s(*first)) first = sensor_index;
  }
  if (!first) {
    ending_ = "all frames are done";
    return std::nullopt;
  }
  wait_until_due(*first);
  if (stop_.is_requested()) return std::nullopt;
  const std::uint64_t number = numbers_[*first]++;
  return FrameRequest{.sensor_index = *first,
                      .number = static_cast<std::uint32_t>(number),
                      .index = number,
                      .due = *due_};
}

void MotionSource::wait_until_due(std::size_t sensor_index) {
  const Clock::time_point now = Clock::now();
  const double before_s = std::exchange(due_s_, start_s(sensor_index));
  if (!due_ || schedule_.rate_hz <= 0.0) {
    due_ = now;
    return;
  }
  const double speed = schedule_.rate_hz * periods_s_.front();
  *due_ += seconds((due_s_ - before_s) / speed);
  if (now > *due_ + seconds(periods_s_[sensor_index] / speed)) {
    ++late_;
    due_ = now;
  }
  while (Clock::now() < *due_ && !stop_.is_requested()) stop_.wait_until(*due_);
}

RigMotion motion_of(const woods2016::Placement& placement, const MovedScene& scene) {
  RigMotion motion;
  motion.world_from_rig =
      ConstantPose{woods2016_world_from_optical(placement.sensor, placement.translation_m) *
                   scene.optical_from_rig};
  const Pose world_from_object = woods2016_world_from_object(placement.object);
  for (const Pose& object_from_instance : scene.object_from_instance) {
    motion.world_from_instance.emplace_back(ConstantPose{world_from_object * object_from_instance});
  }
  return motion;
}

SimulatorSource::SimulatorSource(woods2016::PoseReceiver& receiver, const MovedScene& scene,
                                 const Options& options, const StopRequest& stop)
    : receiver_(receiver), scene_(scene), options_(options), stop_(stop) {}

std::optional<FrameRequest> SimulatorSource::next() {
  if (number_ > 0 && request_.sensor_index + 1 < options_.sensor_count && !stop_.is_requested()) {
    request_.motion.reset();
    ++request_.sensor_index;
    return request_;
  }
  if (options_.schedule.rate_hz > 0.0 && number_ > 0) {
    const Clock::time_point due = last_ + seconds(1.0 / options_.schedule.rate_hz);
    while (Clock::now() < due && !stop_.is_requested()) stop_.wait_until(due);
  }
  const std::optional<woods2016::Placement> placement = wait_for_pose();
  if (!placement) return std::nullopt;
  last_ = Clock::now();
  if (!first_) first_ = last_;
  request_ = {.number = static_cast<std::uint32_t>(number_),
              .index = number_++,
              .due = last_,
              .motion = motion_of(*placement, scene_),
              .stamp_ns = static_cast<std::int64_t>(placement->timestamp)};
  return request_;
}

std::optional<woods2016::Placement> SimulatorSource::wait_for_pose() {
  const Clock::time_point begin = Clock::now();
  while (!is_done()) {
    if (std::optional<woods2016::Placement> placement = receiver_.receive()) return placement;
    if (receiver_.is_over()) {
      ending_ = "the simulator ended";
    } else if (options_.timeout_s && seconds_since(begin) > *options_.timeout_s) {
      has_timed_out_ = true;
      ending_ = fmt::format("no pose came for {} s", *options_.timeout_s);
    } else {
      link::wait_for({&receiver_.pose_socket()}, stop_.descriptor(), kPosePollInterval);
    }
  }
  return std::nullopt;
}

bool SimulatorSource::is_done() {
  if (stop_.is_requested()) return true;
  if (number_ >= options_.schedule.frames) {
    ending_ = "all frames are done";
  } else if (first_ && seconds_since(*first_) >= options_.schedule.duration_s) {
    ending_ = "the duration is over";
  }
  return !ending_.empty();
}

namespace {

/// A free body with a constant angular rate, as with equal moments of inertia.
Trajectory trajectory_of(const lockstep::Body& body, std::int64_t t_ns) {
  if (body.rate_rad_s.isZero(0.0) && body.velocity_m_s.isZero(0.0)) {
    return ConstantPose{body.world_from_body};
  }
  return TorqueFreeRotation(
      {.rate_rad_s = body.world_from_body.linear().transpose() * body.rate_rad_s,
       .world_from_body = body.world_from_body,
       .velocity_m_s = body.velocity_m_s,
       .t0_ns = t_ns});
}

lockstep::Body body_of(const Trajectory& still) {
  return {.world_from_body = std::get<ConstantPose>(still).pose};
}

bool is_trajectory_within_reach(const Trajectory& trajectory) {
  const auto* still = std::get_if<ConstantPose>(&trajectory);
  return still == nullptr || glidar::is_within_reach(still->pose.translation());
}

}  // namespace

RigMotion motion_at(const lockstep::Moment& moment, const PreparedScene& prepared) {
  RigMotion motion = {.world_from_rig = trajectory_of(moment.sensor, moment.t_ns),
                      .world_from_instance = {}};
  for (const lockstep::Body& object : moment.objects) {
    motion.world_from_instance.push_back(trajectory_of(object, moment.t_ns));
  }
  if (moment.objects.empty()) motion.world_from_instance = prepared.motion.world_from_instance;
  return motion;
}

lockstep::Moment static_moment(const RigMotion& motion) {
  lockstep::Moment moment;
  moment.sensor = body_of(motion.world_from_rig);
  const auto is_constant = [](const Trajectory& instance) {
    return std::holds_alternative<ConstantPose>(instance);
  };
  if (!std::ranges::all_of(motion.world_from_instance, is_constant)) return moment;
  for (const Trajectory& instance : motion.world_from_instance) {
    moment.objects.push_back(body_of(instance));
  }
  return moment;
}

bool is_within_reach(const Motion& motion) {
  return is_trajectory_within_reach(motion.world_from_sensor) &&
         std::ranges::all_of(motion.world_from_instance, is_trajectory_within_reach);
}

}  // namespace glidar::app
