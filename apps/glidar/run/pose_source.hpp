// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/interrupt.hpp>
#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/core/beams.hpp>
#include <glidar/link/lockstep.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/woods2016/protocol.hpp>

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// A frame to be measured now.
struct FrameRequest {
  std::size_t sensor_index = 0;  ///< of its sensor among those of the scene
  std::uint32_t number = 0;
  std::uint64_t index =
      0;  ///< index among this sensor's frames; differs from `number` in recordings
  std::chrono::steady_clock::time_point due;  ///< when its pose was known
  /// New poses and their time; empty: unchanged poses, at the frame's own time.
  std::optional<RigMotion> motion = {};
  std::optional<std::int64_t> stamp_ns = {};
  std::optional<std::uint64_t> seed = {};  ///< empty: the command's
  std::string frame_hash = {};             ///< expected frame_hash(); empty: unknown
};

/// The rate of frames and when they end.
struct FrameSchedule {
  double rate_hz = 0.0;                                              ///< at most; 0: no limit
  std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();  ///< of each sensor
  double duration_s = std::numeric_limits<double>::infinity();
};

/// The source of the poses of a stream.
class PoseSource {
 public:
  PoseSource() = default;
  PoseSource(const PoseSource&) = delete;
  PoseSource& operator=(const PoseSource&) = delete;
  virtual ~PoseSource() = default;

  /// Waits for the next frame. Empty: there are no more frames, or a signal arrived.
  virtual std::optional<FrameRequest> next() = 0;
  /// Why there are no more frames; empty before.
  [[nodiscard]] virtual std::string ending() const = 0;
  /// Whether they ended because no pose came in time.
  [[nodiscard]] virtual bool has_timed_out() const { return false; }
};

/// Frames of the motion by the command line or the scene file, one per period of each sensor, in
/// the order of their times.
class MotionSource final : public PoseSource {
 public:
  /// `periods_s`: from one frame to the next in each sensor's own time. The rate of the schedule is
  /// that of the first sensor.
  MotionSource(const FrameSchedule& schedule, std::vector<double> periods_s,
               const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return ending_; }
  /// Frames that were late by more than a period; later frames are postponed.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  [[nodiscard]] double start_s(std::size_t sensor_index) const;
  [[nodiscard]] bool is_done(std::size_t sensor_index) const;
  void wait_until_due(std::size_t sensor_index);

  FrameSchedule schedule_;
  std::vector<double> periods_s_;
  const StopRequest& stop_;
  std::optional<std::chrono::steady_clock::time_point> due_;
  double due_s_ = 0.0;                  ///< the sensors' time at due_
  std::vector<std::uint64_t> numbers_;  ///< of each sensor's next frame
  std::uint64_t late_ = 0;
  std::string ending_;
};

/// The parts of the scene that a simulator's message moves.
struct MovedScene {
  std::vector<Pose> object_from_instance;  ///< the scene, which is the message's object
  Pose optical_from_rig = Pose::Identity();
};

/// The poses of the rig and all instances by a message.
RigMotion motion_of(const woods2016::Placement& placement, const MovedScene& scene);

/// A frame of each sensor for each pose of a simulator. Its timestamps become the frames' stamps,
/// in any unit.
class SimulatorSource final : public PoseSource {
 public:
  struct Options {
    FrameSchedule schedule;
    std::optional<double> timeout_s;  ///< for a pose; empty: no limit
    std::size_t sensor_count = 1;     ///< sensors measured at each pose
  };
  /// All must outlive it.
  SimulatorSource(woods2016::PoseReceiver& receiver, const MovedScene& scene,
                  const Options& options, const StopRequest& stop);
  std::optional<FrameRequest> next() override;
  [[nodiscard]] std::string ending() const override { return ending_; }
  [[nodiscard]] bool has_timed_out() const override { return has_timed_out_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<woods2016::Placement> wait_for_pose();
  [[nodiscard]] bool is_done();

  woods2016::PoseReceiver& receiver_;
  const MovedScene& scene_;
  Options options_;
  const StopRequest& stop_;
  std::optional<Clock::time_point> first_;  ///< pose
  Clock::time_point last_;                  ///< pose
  std::uint64_t number_ = 0;                ///< of the next pose
  FrameRequest request_;                    ///< the last one
  bool has_timed_out_ = false;
  std::string ending_;
};

/// The motion of the rig and all instances from the state of a moment on. Without objects in it,
/// they move as prepared.
RigMotion motion_at(const lockstep::Moment& moment, const PreparedScene& prepared);

/// The bodies of a motion with a constant pose of the rig; without the objects if any of them
/// moves.
lockstep::Moment static_moment(const RigMotion& motion);

/// Whether a sensor and the instances of a motion with constant poses are within kMaxCoordinate_m;
/// what moves is not checked.
bool is_within_reach(const Motion& motion);

}  // namespace glidar::app
