// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/link/dds/domain.hpp>
#include <glidar/link/dds/pose_decoder.hpp>
#include <glidar/link/dds/topic_names.hpp>
#include <glidar/link/dds/wake_up.hpp>
#include <glidar/link/error_log.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar::dds {

/// RAII: gives the warnings of Cyclone DDS to a log instead of standard error. Cyclone DDS has one
/// destination per process: with several objects, each gets all warnings.
class LogSink {
 public:
  /// The log must outlive it.
  explicit LogSink(link::ErrorLog& log);
  ~LogSink();
  LogSink(const LogSink&) = delete;
  LogSink& operator=(const LogSink&) = delete;

 private:
  link::ErrorLog& log_;
};

/// False in builds without Cyclone DDS.
bool has_dds();

/// A participant of a DDS domain that ROS 2 nodes find. It outlives all its writers and readers,
/// and the first one in a domain outlives the others of its process, which use its network
/// interface.
class Participant {
 public:
  /// Joins the domain. Reports warnings, such as small socket buffers, to the log, which must
  /// outlive it. Throws Error when the domain is not valid or there is no such network interface,
  /// and in builds without Cyclone DDS.
  Participant(const DomainOptions& options, link::ErrorLog& errors);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] std::int32_t handle() const { return handle_; }
  [[nodiscard]] std::uint32_t domain() const { return id_; }
  [[nodiscard]] link::ErrorLog& errors() const { return errors_; }

 private:
  link::ErrorLog& errors_;
  std::uint32_t id_ = 0;
  LogSink sink_;
  std::int32_t domain_handle_ = 0;  ///< negative: another participant has it
  std::int32_t handle_ = 0;
};

/// A writer of another participant.
struct Publication {
  std::string type_name;  ///< in DDS: nav_msgs::msg::dds_::Odometry_
  bool reliable = false;
  bool transient_local = false;
};

/// Finds the writers of a topic in a domain.
class Publications {
 public:
  /// Signals `wake_up`, which must outlive it, when writers of any topic appear. Throws Error.
  Publications(const Participant& participant, const WakeUp& wake_up);
  ~Publications();
  Publications(const Publications&) = delete;
  Publications& operator=(const Publications&) = delete;

  /// Those that exist now.
  [[nodiscard]] std::vector<Publication> of(const std::string& full_name) const;

 private:
  std::int32_t participant_ = 0;
  std::int32_t handle_ = 0;
};

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
