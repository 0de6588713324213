// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace glidar::ros {

/// Keeps the messages in memory.
class MemorySink final : public MessageSink {
 public:
  struct Written {
    std::string topic;
    std::int64_t time_ns = 0;
    std::vector<std::byte> bytes;
  };

  std::size_t add_topic(const Topic& topic) override {
    topics.push_back(topic);
    return topics.size() - 1;
  }
  [[nodiscard]] bool is_wanted(std::size_t topic) const override {
    return !wanted || wanted(topics.at(topic).name);
  }
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override {
    messages.push_back({topics.at(topic).name, time_ns, {message.begin(), message.end()}});
  }
  void finish() override {}

  /// The messages of a topic.
  template <class Message>
  [[nodiscard]] std::vector<Message> of(const std::string& topic) const {
    std::vector<Message> found;
    for (const Written& written : messages)
      if (written.topic == topic) found.push_back(deserialize<Message>(written.bytes));
    return found;
  }
  [[nodiscard]] std::map<std::string, std::size_t> counts() const {
    std::map<std::string, std::size_t> counts;
    for (const Written& written : messages) ++counts[written.topic];
    return counts;
  }

  std::vector<Topic> topics;
  std::vector<Written> messages;
  std::function<bool(const std::string& topic)> wanted;  ///< empty: all are
};

}  // namespace glidar::ros
