// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/wake_up.hpp>
#include <glidar/link/payload.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

struct dds_qos;
struct ddsi_serdata;
struct ddsi_sertype;

namespace glidar::dds {

using QosPointer = std::unique_ptr<dds_qos, void (*)(dds_qos*)>;

/// A result of Cyclone DDS, which is negative for errors. Throws Error for these.
std::int32_t checked(std::int32_t result, const std::string& where, const char* doing);

/// The QoS of a writer or reader of ROS 2, with the hash of its type as user data.
QosPointer endpoint_qos(const ros::MessageType& type, const ros::Qos& qos);

/// A topic of serialized messages.
struct Topic {
  std::int32_t handle = 0;
  const ddsi_sertype* type = nullptr;  ///< owned by the topic
};
Topic create_topic(const Participant& participant, const std::string& full_name,
                   const ros::MessageType& type, std::size_t max_received_bytes);

// Serialized types: the types of topics as Cyclone DDS sees them. Messages are serialized before
// they are written and deserialized after they are read, so that one codec (glidar/io/ros) serves
// files and networks. The types carry no type information of XTypes: Cyclone DDS 0.10.2 crashes
// when a reader announces that of a newer implementation.

/// A type without keys in XCDR1. Received messages above `max_received_bytes` are discarded.
/// The caller gives it to dds_create_topic_sertype().
ddsi_sertype* new_serialized_type(const std::string& type_name, std::size_t max_received_bytes);

/// A message of this type: CDR with its header of 4 bytes. Copies no bytes; the memory is released
/// after all readers have acknowledged it. The caller gives it to dds_writecdr().
ddsi_serdata* new_serialized_message(const ddsi_sertype& type, const link::Payload& message);

/// The bytes of a message, shared with it.
link::Payload payload_of(const ddsi_serdata& message);

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
