// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/ros2_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/pose_source.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <apps/glidar/run/rig_messages.hpp>
#include <glidar/link/dds/clock_subscriber.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/pose_subscriber.hpp>
#include <glidar/link/error_log.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::app {

/// When the frames of a source in ROS 2 end.
struct Ros2Schedule {
  FrameSchedule frames;             ///< its rate counts in the time of the poses
  std::optional<double> timeout_s;  ///< for a pose; empty: no limit
};

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

/// The connection of a stream to ROS 2. It outlives the sink and the source that it makes.
class Ros2Link {
 public:
  /// Joins the domain. Flags and log must outlive it. Throws Error.
  Ros2Link(const Ros2Flags& flags, link::ErrorLog& errors);

  /// Publishes frames. `speed`: how fast their time passes; 0: it is not related to real time.
  [[nodiscard]] std::unique_ptr<FrameSink> make_sink(const RenderFlags& flags,
                                                     const PreparedScene& prepared,
                                                     PoseOrigin origin, double speed) const;
  /// Subscribes to the poses, or the clock, of the flags. `queue`: poses that wait; 0: the newest
  /// only.
  std::unique_ptr<PoseSource> make_source(const Ros2Schedule& schedule, std::size_t queue,
                                          const PreparedScene& prepared, const StopRequest& stop);

 private:
  const Ros2Flags& flags_;
  dds::Participant participant_;
  std::unique_ptr<dds::PoseSubscriber> poses_;
  std::unique_ptr<dds::ClockSubscriber> clock_;
};

}  // namespace glidar::app
