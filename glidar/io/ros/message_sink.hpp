// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/io/ros/message_types.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glidar::ros {

/// A topic and the type of its messages.
struct Topic {
  std::string name;  ///< with a leading slash: /points
  const MessageType* type = nullptr;
  Qos qos;
};

/// A topic with the default quality of service of its type.
template <class Message>
Topic make_topic(std::string name) {
  const MessageType& type = message_type<Message>();
  return {std::move(name), &type, type.qos};
}

/// A destination of messages, which are Wire::cdr: a bag or a network.
class MessageSink {
 public:
  MessageSink() = default;
  MessageSink(const MessageSink&) = delete;
  MessageSink& operator=(const MessageSink&) = delete;
  virtual ~MessageSink() = default;

  /// The number of a new topic. Throws Error when its name is in use or no topic name.
  virtual std::size_t add_topic(const Topic& topic) = 0;
  /// Whether anyone receives the topic now; if not, its messages need not be made.
  [[nodiscard]] virtual bool is_wanted(std::size_t /*topic*/) const { return true; }
  /// Takes a serialized message; the bytes are valid during the call. Times need not increase.
  /// Throws Error for times before 1970, unknown topics and when the system refuses.
  virtual void write(std::size_t topic, std::int64_t time_ns,
                     std::span<const std::byte> message) = 0;
  /// The same for bytes that the sink may keep. It leaves unspecified bytes, whose memory can be
  /// used for another message.
  virtual void take(std::size_t topic, std::int64_t time_ns, std::vector<std::byte>& message) {
    write(topic, time_ns, message);
  }
  /// Call after the last message: completes a bag. Throws Error.
  virtual void finish() = 0;
};

/// Serializes and writes a message.
template <class Message>
void write_message(MessageSink& sink, std::size_t topic, std::int64_t time_ns,
                   const Message& message) {
  sink.write(topic, time_ns, serialize(message));
}

}  // namespace glidar::ros
