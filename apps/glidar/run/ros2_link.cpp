// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/ros2_link.hpp>

#include <apps/glidar/options/message_options.hpp>
#include <glidar/core/report.hpp>
#include <glidar/output/network.hpp>
#include <glidar/sensor/sensor.hpp>

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {
namespace {

/// What others publish when they give the poses or the time.
std::vector<std::string> omitted_topics(const Ros2Flags& flags) {
  if (flags.pose_topic.empty()) return {};
  if (follows_ros_clock(flags)) return {"/clock"};
  return {"/tf", "/odom", "/ground_truth/odom", "/clock"};
}

using Clock = std::chrono::steady_clock;

constexpr double kSecond_ns = 1e9;

/// How often a wait checks its time limit.
constexpr int kPoll_ms = 100;

/// Ends a source, and waits for messages until then.
class Ros2Wait {
 public:
  Ros2Wait(const Ros2Schedule& schedule, const StopRequest& stop)
      : schedule_(schedule), stop_(stop) {}
  /// Whether the frames are done: by their number, the duration or a signal.
  bool is_done(std::uint64_t frames);
  /// Waits at the descriptor of a subscriber. False: the timeout since the last message is over.
  bool wait(int descriptor);
  /// A message has arrived.
  void restart() { begin_ = std::chrono::steady_clock::now(); }
  void count_first_frame();
  [[nodiscard]] const std::string& ending() const { return ending_; }
  [[nodiscard]] bool has_timed_out() const { return has_timed_out_; }

 private:
  Ros2Schedule schedule_;
  const StopRequest& stop_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::optional<std::chrono::steady_clock::time_point> first_;  ///< frame
  std::string ending_;
  bool has_timed_out_ = false;
};

/// Whether a pose with this stamp gives a frame, at most `rate_hz` of them per second of stamps.
class StampPace {
 public:
  explicit StampPace(double rate_hz);
  /// Stamps that jump back start again.
  bool is_due(std::int64_t stamp_ns);

 private:
  std::int64_t period_ns_ = 0;  ///< 0: no limit
  std::optional<std::int64_t> due_ns_;
  std::int64_t last_ns_ = 0;
};

/// A frame of each sensor for poses of the rig, with their stamps. The objects of the scene move as
/// prepared.
class Ros2PoseSource final : public PoseSource {
 public:
  /// All must outlive it.
  Ros2PoseSource(dds::PoseSubscriber& subscriber, const Ros2Schedule& schedule,
                 const PreparedScene& prepared, const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return wait_.ending(); }
  [[nodiscard]] bool has_timed_out() const override { return wait_.has_timed_out(); }

 private:
  std::optional<TimedPose> wait_for_pose();

  dds::PoseSubscriber& subscriber_;
  const PreparedScene& prepared_;
  const StopRequest& stop_;
  Ros2Wait wait_;
  StampPace pace_;
  std::uint64_t number_ = 0;  ///< of the next pose
  FrameRequest request_;      ///< the last one
};

/// The frames of sensors at the times of /clock: frame 0 at the first time. Frames that are not yet
/// measured when the next one is due are skipped.
class ClockSource final : public PoseSource {
 public:
  /// All must outlive it.
  ClockSource(dds::ClockSubscriber& clock, const Ros2Schedule& schedule,
              std::span<const ActiveSensor> sensors, const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return wait_.ending(); }
  [[nodiscard]] bool has_timed_out() const override { return wait_.has_timed_out(); }

 private:
  void set_time(std::int64_t time_ns);
  [[nodiscard]] std::int64_t start_ns(std::size_t sensor, std::uint32_t number) const;
  std::optional<FrameRequest> due_frame();

  dds::ClockSubscriber& clock_;
  std::span<const ActiveSensor> sensors_;
  const StopRequest& stop_;
  Ros2Wait wait_;
  std::optional<std::int64_t> time_ns_;
  std::int64_t origin_ns_ = 0;          ///< time of frame 0
  std::vector<std::uint32_t> numbers_;  ///< of each sensor's next frame
  std::vector<std::uint64_t> indices_;  ///< of each sensor's next frame among those measured
  std::uint64_t frames_ = 0;            ///< measured
};

bool Ros2Wait::is_done(std::uint64_t frames) {
  if (stop_.is_requested()) return true;
  if (frames >= schedule_.frames.frames) {
    ending_ = "all frames are done";
  } else if (first_ && seconds_since(*first_) >= schedule_.frames.duration_s) {
    ending_ = "the duration is over";
  }
  return !ending_.empty();
}

bool Ros2Wait::wait(int descriptor) {
  if (schedule_.timeout_s && seconds_since(begin_) > *schedule_.timeout_s) {
    has_timed_out_ = true;
    ending_ = fmt::format("no pose came for {} s", *schedule_.timeout_s);
    return false;
  }
  std::array<pollfd, 2> entries = {
      pollfd{.fd = descriptor, .events = POLLIN, .revents = 0},
      pollfd{.fd = stop_.descriptor(), .events = POLLIN, .revents = 0}};
  poll(entries.data(), entries.size(), kPoll_ms);
  return true;
}

void Ros2Wait::count_first_frame() {
  if (!first_) first_ = Clock::now();
}

StampPace::StampPace(double rate_hz)
    : period_ns_(rate_hz > 0.0 ? std::llround(kSecond_ns / rate_hz) : 0) {}

bool StampPace::is_due(std::int64_t stamp_ns) {
  const bool is_back = due_ns_ && stamp_ns < last_ns_;
  last_ns_ = stamp_ns;
  if (due_ns_ && !is_back && stamp_ns < *due_ns_) return false;
  const bool is_regular = due_ns_ && !is_back && stamp_ns - *due_ns_ < period_ns_;
  due_ns_ = (is_regular ? *due_ns_ : stamp_ns) + period_ns_;
  return true;
}

Ros2PoseSource::Ros2PoseSource(dds::PoseSubscriber& subscriber, const Ros2Schedule& schedule,
                               const PreparedScene& prepared, const StopRequest& stop)
    : subscriber_(subscriber),
      prepared_(prepared),
      stop_(stop),
      wait_(schedule, stop),
      pace_(schedule.frames.rate_hz) {}

std::optional<FrameRequest> Ros2PoseSource::next() {
  if (number_ > 0 && request_.sensor_index + 1 < prepared_.sensors.size() &&
      !stop_.is_requested()) {
    request_.motion.reset();
    ++request_.sensor_index;
    return request_;
  }
  const std::optional<TimedPose> pose = wait_for_pose();
  if (!pose) return std::nullopt;
  wait_.count_first_frame();
  Pose world_from_rig = Pose::Identity();
  world_from_rig.linear() = pose->orientation.toRotationMatrix();
  world_from_rig.translation() = pose->position_m;
  request_ = {.number = static_cast<std::uint32_t>(number_),
              .index = number_++,
              .due = Clock::now(),
              .motion = RigMotion{.world_from_rig = ConstantPose{world_from_rig},
                                  .world_from_instance = prepared_.motion.world_from_instance},
              .stamp_ns = pose->t_ns};
  return request_;
}

std::optional<TimedPose> Ros2PoseSource::wait_for_pose() {
  wait_.restart();
  while (!wait_.is_done(number_)) {
    if (const std::optional<TimedPose> pose = subscriber_.receive()) {
      wait_.restart();
      if (pace_.is_due(pose->t_ns)) return pose;
    } else if (!wait_.wait(subscriber_.descriptor())) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

ClockSource::ClockSource(dds::ClockSubscriber& clock, const Ros2Schedule& schedule,
                         std::span<const ActiveSensor> sensors, const StopRequest& stop)
    : clock_(clock),
      sensors_(sensors),
      stop_(stop),
      wait_(schedule, stop),
      numbers_(sensors.size()),
      indices_(sensors.size()) {}

std::optional<FrameRequest> ClockSource::next() {
  wait_.restart();
  while (!wait_.is_done(frames_ / sensors_.size())) {
    if (const std::optional<std::int64_t> time_ns = clock_.receive()) {
      wait_.restart();
      set_time(*time_ns);
    }
    if (std::optional<FrameRequest> request = due_frame()) {
      wait_.count_first_frame();
      ++frames_;
      return request;
    }
    if (!wait_.wait(clock_.descriptor())) break;
  }
  return std::nullopt;
}

/// A clock that jumps back starts again with frame 0.
void ClockSource::set_time(std::int64_t time_ns) {
  if (!time_ns_ || time_ns < *time_ns_) {
    origin_ns_ = time_ns;
    numbers_.assign(numbers_.size(), 0);
  }
  time_ns_ = time_ns;
}

std::int64_t ClockSource::start_ns(std::size_t sensor, std::uint32_t number) const {
  return origin_ns_ + frame_interval(sensors_[sensor].sensor, number).start_ns;
}

/// The frame that is due first; of each sensor, the newest one that is due.
std::optional<FrameRequest> ClockSource::due_frame() {
  if (!time_ns_) return std::nullopt;
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const double periods =
        static_cast<double>(*time_ns_ - origin_ns_) / kSecond_ns * sensors_[i].sensor.rate_hz;
    constexpr double kMaxNumber = 4e9;
    const auto newest = static_cast<std::uint32_t>(std::clamp(periods, 0.0, kMaxNumber));
    numbers_[i] = std::max(numbers_[i], newest);
    if (start_ns(i, numbers_[i]) > *time_ns_) continue;
    if (!first || start_ns(i, numbers_[i]) < start_ns(*first, numbers_[*first])) first = i;
  }
  if (!first) return std::nullopt;
  const std::uint32_t number = numbers_[*first]++;
  return FrameRequest{.sensor_index = *first,
                      .number = number,
                      .index = indices_[*first]++,
                      .due = Clock::now(),
                      .stamp_ns = start_ns(*first, number)};
}

}  // namespace

Ros2Link::Ros2Link(const Ros2Flags& flags, link::ErrorLog& errors)
    : flags_(flags), participant_({.id = {}, .interface_name = flags.interface_name}, errors) {}

std::unique_ptr<Output> Ros2Link::open(const OutputRig& rig, const OutputOptions& options,
                                       double speed) const {
  return open_ros2_output(
      participant_, {.ros_namespace = flags_.ros_namespace, .omitted = omitted_topics(flags_)}, rig,
      options, speed);
}

std::unique_ptr<PoseSource> Ros2Link::make_source(const Ros2Schedule& schedule, std::size_t queue,
                                                  const PreparedScene& prepared,
                                                  const StopRequest& stop) {
  if (follows_ros_clock(flags_)) {
    clock_ = std::make_unique<dds::ClockSubscriber>(participant_);
    return std::make_unique<ClockSource>(*clock_, schedule, prepared.sensors, stop);
  }
  const dds::PoseTopic topic = dds::parse_pose_topic(flags_.pose_topic, flags_.ros_namespace);
  poses_ = std::make_unique<dds::PoseSubscriber>(participant_, topic, queue);
  return std::make_unique<Ros2PoseSource>(*poses_, schedule, prepared, stop);
}

}  // namespace glidar::app
