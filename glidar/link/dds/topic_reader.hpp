// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/message_types.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/wake_up.hpp>
#include <glidar/link/payload.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace glidar::dds {

/// Larger messages of poses are discarded.
inline constexpr std::size_t kMaxPoseMessage_bytes = std::size_t{1} << 20;

/// A ROS topic to read.
struct ReaderOptions {
  std::string full_name;  ///< of full_topic_name()
  const ros::MessageType& type;
  ros::Qos qos;  ///< of a subscription; keeps the last `depth` messages
  std::size_t max_message_bytes = kMaxPoseMessage_bytes;
};

/// Receives the messages of a ROS topic, except those of its own participant.
class TopicReader {
 public:
  /// Signals `wake_up`, which must outlive it, after every message. Throws Error.
  TopicReader(const Participant& participant, const ReaderOptions& options, const WakeUp& wake_up);
  ~TopicReader();
  TopicReader(const TopicReader&) = delete;
  TopicReader& operator=(const TopicReader&) = delete;

  /// The next message, CDR with its header, which may be damaged. Never blocks.
  std::optional<link::Payload> take();

 private:
  std::int32_t topic_ = 0;
  std::int32_t handle_ = 0;
};

}  // namespace glidar::dds
