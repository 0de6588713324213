// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/written_topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace glidar::bags {
namespace {

constexpr std::size_t kMaxTopics = 65000;  // channels of MCAP have numbers of 16 bits

/// Names of ROS: design.ros2.org/articles/topic_and_service_names.html.
bool is_topic_name(const std::string& name) {
  const auto is_valid = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/';
  };
  return name.size() > 1 && name.front() == '/' && name.back() != '/' &&
         name.find("//") == std::string::npos && std::all_of(name.begin(), name.end(), is_valid);
}

}  // namespace

std::size_t WrittenTopics::add(const ros::Topic& topic) {
  if (!is_topic_name(topic.name)) {
    throw Error({place_, "a topic '" + excerpt(topic.name) + "'",
                 "'/' and letters, digits, '_' and '/'", "name it /points, for example"});
  }
  const auto is_same = [&](const WrittenTopic& known) { return known.name == topic.name; };
  if (std::any_of(topics_.begin(), topics_.end(), is_same))
    throw Error({place_, "the topic " + topic.name + " a second time", "each topic once"});
  if (topic.type == nullptr) throw Error({place_, "the topic " + topic.name + " without a type"});
  if (topics_.size() == kMaxTopics)
    throw Error({place_, "more topics", fmt::format("at most {}", kMaxTopics)});
  topics_.push_back({topic.name, topic.type, topic.qos, 0});
  return topics_.size() - 1;
}

WrittenTopic& WrittenTopics::count(std::size_t topic, std::int64_t time_ns) {
  if (topic >= topics_.size())
    throw Error({place_, fmt::format("a message of topic {}", topic), "a topic that was added"});
  if (time_ns < 0) {
    throw Error({place_, fmt::format("a message at {} ns", time_ns), "times since 1970",
                 "start the simulation at 0 or later"});
  }
  const auto time = static_cast<std::uint64_t>(time_ns);
  first_ns_ = messages_ == 0 ? time : std::min(first_ns_, time);
  last_ns_ = std::max(last_ns_, time);
  ++messages_;
  ++topics_[topic].messages;
  return topics_[topic];
}

}  // namespace glidar::bags
