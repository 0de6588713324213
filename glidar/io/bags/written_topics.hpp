// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io/bags.

#include <glidar/io/bags/bag.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glidar::bags {

/// A topic of a bag that is being written.
struct WrittenTopic {
  std::string name;
  const ros::MessageType* type = nullptr;
  ros::Qos qos;
  std::uint64_t messages = 0;
};

/// The topics of a bag and the times of its messages.
class WrittenTopics {
 public:
  /// `place` is the path of the bag, for errors.
  explicit WrittenTopics(std::string place) : place_(std::move(place)) {}

  /// Throws Error for a name that is in use or none of a topic.
  std::size_t add(const ros::Topic& topic);
  /// Counts a message. Throws Error for an unknown topic and a time before 1970.
  WrittenTopic& count(std::size_t topic, std::int64_t time_ns);

  [[nodiscard]] const std::vector<WrittenTopic>& all() const { return topics_; }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t first_ns() const { return first_ns_; }
  [[nodiscard]] std::uint64_t last_ns() const { return last_ns_; }

 private:
  std::string place_;
  std::vector<WrittenTopic> topics_;
  std::uint64_t messages_ = 0;
  std::uint64_t first_ns_ = 0;
  std::uint64_t last_ns_ = 0;
};

}  // namespace glidar::bags
