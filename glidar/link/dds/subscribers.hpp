// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/pose_decoder.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace glidar::dds {

/// Totals since the start.
struct PoseCounts {
  std::uint64_t received = 0;  ///< messages
  std::uint64_t invalid = 0;   ///< messages that were discarded
  std::uint64_t skipped = 0;   ///< poses that a newer one replaced
};

/// Receives the poses of a moving body from ROS 2: of nav_msgs/Odometry or
/// geometry_msgs/PoseStamped, whichever is published, or of two frames in /tf and /tf_static.
/// Messages that are not valid are reported to the participant's log and discarded.
class PoseSubscriber {
 public:
  /// `queue`: poses that wait to be received; the oldest ones are dropped. 0: the newest only.
  PoseSubscriber(const Participant& participant, const PoseTopic& topic, std::size_t queue);
  ~PoseSubscriber();
  PoseSubscriber(const PoseSubscriber&) = delete;
  PoseSubscriber& operator=(const PoseSubscriber&) = delete;

  /// The next pose, if there is one. Never blocks.
  std::optional<TimedPose> receive();
  /// A file descriptor that is readable when receive() may have a pose.
  [[nodiscard]] int descriptor() const;
  [[nodiscard]] PoseCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Receives the simulation's time from /clock.
class ClockSubscriber {
 public:
  explicit ClockSubscriber(const Participant& participant);
  ~ClockSubscriber();
  ClockSubscriber(const ClockSubscriber&) = delete;
  ClockSubscriber& operator=(const ClockSubscriber&) = delete;

  /// The newest time that was not returned yet, ns. Never blocks.
  std::optional<std::int64_t> receive();
  [[nodiscard]] int descriptor() const;
  [[nodiscard]] PoseCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glidar::dds
