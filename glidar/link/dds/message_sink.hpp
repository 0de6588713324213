// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/topics.hpp>
#include <glidar/link/dds/wake_up.hpp>
#include <glidar/link/payload.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace glidar::dds {

struct MessageSinkOptions {
  std::string ros_namespace = {};  ///< of all topics but /tf, /tf_static and /clock
  /// Topics that others publish, such as /clock: they are not created.
  std::vector<std::string> omitted = {};
};

/// Publishes topics in a domain of DDS.
class MessageSink final : public ros::MessageSink {
 public:
  /// The participant must outlive it. Throws Error when the namespace is not valid.
  MessageSink(const Participant& participant, MessageSinkOptions options);

  std::size_t add_topic(const ros::Topic& topic) override;
  /// Whether a node reads the topic. The last message of a transient local topic is always wanted.
  [[nodiscard]] bool is_wanted(std::size_t topic) const override;
  /// Never blocks; copies the message once.
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override;
  /// The same; keeps large messages instead of copying them.
  void take(std::size_t topic, std::int64_t time_ns, std::vector<std::byte>& message) override;
  /// Waits up to a second until reliable readers have acknowledged the messages.
  void finish() override;
  /// Logs those of its topics that other programs publish too, whenever there are more of them.
  /// Transforms have several publishers by design.
  void report_other_publishers();
  /// Messages published.
  [[nodiscard]] std::uint64_t count() const;

 private:
  const Participant& participant_;
  MessageSinkOptions options_;
  std::vector<std::unique_ptr<TopicWriter>> writers_;  ///< per topic; nullptr: omitted
  std::vector<bool> is_kept_;                          ///< per topic: transient local
  link::PayloadPool memory_;
  WakeUp publisher_appeared_;
  Publications others_;
  std::vector<std::string> contested_;  ///< topics that were logged
};

}  // namespace glidar::dds
