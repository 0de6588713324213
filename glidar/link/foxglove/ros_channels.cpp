// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/ros_channels.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace glidar::foxglove {
namespace {

/// Messages that a slow client receives late rather than never: as many as of a second.
std::size_t depth_of(const ros::MessageType& type) {
  constexpr std::size_t kSecond = 400;
  const bool is_series = &type == &ros::message_type<ros::TFMessage>() ||
                         &type == &ros::message_type<ros::Odometry>() ||
                         &type == &ros::message_type<ros::Imu>();
  return is_series ? kSecond : 1;
}

}  // namespace

std::size_t RosChannels::add_topic(const ros::Topic& topic) {
  const ChannelId channel =
      server_.add_channel({.topic = topic.name,
                           .schema_name = std::string(topic.type->name),
                           .schema = definition_text(*topic.type),
                           .depth = topic.qos.transient_local ? 1 : depth_of(*topic.type)});
  topics_.push_back(
      {.channel = channel, .is_clock = topic.type == &ros::message_type<ros::Clock>()});
  return topics_.size() - 1;
}

bool RosChannels::is_wanted(std::size_t topic) const {
  return keeps_newest_ || server_.is_subscribed(topics_.at(topic).channel);
}

void RosChannels::write(std::size_t topic, std::int64_t time_ns,
                        std::span<const std::byte> message) {
  if (time_ns < 0) {
    throw Error({"live view", "a message at " + std::to_string(time_ns) + " ns", "times since 1970",
                 "start the simulation at 0 or later"});
  }
  const auto time = static_cast<std::uint64_t>(time_ns);
  Entry& entry = topics_.at(topic);
  link::Payload payload = entry.pool.take(message.size());
  std::copy(message.begin(), message.end(), payload.bytes().begin());
  server_.publish(entry.channel, time, std::move(payload));
  if (entry.is_clock) server_.publish_time(time);
}

}  // namespace glidar::foxglove
