// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/message_types.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/payload.hpp>

#include <chrono>
#include <cstdint>
#include <string>

struct ddsi_sertype;

namespace glidar::dds {

/// Publishes the messages of a ROS topic. Keeps the last `qos.depth` messages until all reliable
/// readers have acknowledged them. A reader that is slower than the writer misses the older ones:
/// writing never waits.
class TopicWriter {
 public:
  /// `full_name`: of full_topic_name(). Throws Error.
  TopicWriter(const Participant& participant, const std::string& full_name,
              const ros::MessageType& type, const ros::Qos& qos);
  ~TopicWriter();
  TopicWriter(const TopicWriter&) = delete;
  TopicWriter& operator=(const TopicWriter&) = delete;

  /// CDR with its header. Never blocks and copies no payload, whose memory must not change any
  /// more. False, with an entry in the participant's log, if it was not sent.
  bool write(const link::Payload& message);
  /// Whether any reader is matched, so that a message need not be made otherwise. Readers that come
  /// late to a transient local topic want it too.
  [[nodiscard]] bool has_readers() const;
  /// Waits until all reliable readers have acknowledged all messages. False after the timeout.
  [[nodiscard]] bool wait_for_acknowledgements(std::chrono::milliseconds timeout) const;
  /// The full name of the topic.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Messages sent.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  link::ErrorLog& errors_;
  std::string name_;
  const ddsi_sertype* type_ = nullptr;
  std::int32_t topic_ = 0;
  std::int32_t handle_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace glidar::dds
