// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/interrupt.hpp>
#include <glidar/core/beams.hpp>
#include <glidar/link/legacy/pose_receiver.hpp>
#include <glidar/motion/motion.hpp>

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// A frame that is to be measured now.
struct Moment {
  std::uint32_t number = 0;
  std::int64_t stamp_ns = 0;
  std::chrono::steady_clock::time_point due;  ///< when its pose was there
};

/// How long and how quickly frames follow each other.
struct Pace {
  double rate_hz = 0.0;  ///< at most; 0: no limit
  std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
  double duration_s = std::numeric_limits<double>::infinity();
};

/// Where the poses of a stream come from.
class PoseSource {
 public:
  PoseSource() = default;
  PoseSource(const PoseSource&) = delete;
  PoseSource& operator=(const PoseSource&) = delete;
  virtual ~PoseSource() = default;

  /// Waits for the next frame and moves everything to where it is then. Empty: there is no more, or
  /// a signal came.
  virtual std::optional<Moment> next(Motion& motion) = 0;
  /// Why there is no more; empty while there is.
  [[nodiscard]] virtual std::string ending() const = 0;
};

/// Frames of the command line's or the scene file's motion, one for each period of the sensor.
class MotionSource final : public PoseSource {
 public:
  /// `period_s`: from one frame to the next in the sensor's own time.
  MotionSource(const Pace& pace, double period_s, const StopRequest& stop);
  std::optional<Moment> next(Motion& motion) override;
  [[nodiscard]] std::string ending() const override { return ending_; }
  /// Frames that came after they were due by more than a period; the later ones are put off.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  void wait_until_due();

  Pace pace_;
  double period_s_;
  const StopRequest& stop_;
  std::optional<std::chrono::steady_clock::time_point> due_;
  std::uint64_t number_ = 0;
  std::uint64_t late_ = 0;
  std::string ending_;
};

/// What stands still and what a simulator's message moves.
struct MovedScene {
  std::vector<Pose> object_from_instance;  ///< the scene as it is, which is the message's object
  Pose optical_from_sensor = Pose::Identity();
};

/// The sensor and all instances where a message puts them.
Motion motion_of(const legacy::Placement& placement, const MovedScene& scene);

/// A frame for each pose of a simulator; its timestamps become the frames' stamps, whatever their
/// unit.
class SimulatorSource final : public PoseSource {
 public:
  struct Options {
    Pace pace;
    std::optional<double> timeout_s;  ///< without a pose; empty: waits for ever
  };
  /// All must outlive it.
  SimulatorSource(legacy::PoseReceiver& receiver, const MovedScene& scene, const Options& options,
                  const StopRequest& stop);
  std::optional<Moment> next(Motion& motion) override;
  [[nodiscard]] std::string ending() const override { return ending_; }
  [[nodiscard]] bool has_timed_out() const { return has_timed_out_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<legacy::Placement> wait_for_pose();
  [[nodiscard]] bool is_over();

  legacy::PoseReceiver& receiver_;
  const MovedScene& scene_;
  Options options_;
  const StopRequest& stop_;
  std::optional<Clock::time_point> first_;  ///< pose
  Clock::time_point last_ = Clock::now();   ///< pose, or the start
  std::uint64_t number_ = 0;
  bool has_timed_out_ = false;
  std::string ending_;
};

}  // namespace glidar::app
