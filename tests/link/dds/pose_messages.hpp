// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>
#include <glidar/io/ros/messages.hpp>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <glidar/link/payload.hpp>

namespace glidar::testing {

inline ros::TransformStamped transform(const std::string& parent, const std::string& child,
                                       std::int32_t sec, ros::Vector3 translation,
                                       ros::Quaternion rotation = {}) {
  ros::TransformStamped message;
  message.header.stamp.sec = sec;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = {translation, rotation};
  return message;
}

inline ros::Odometry odometry(std::int32_t sec, ros::Vector3 position) {
  ros::Odometry message;
  message.header.stamp.sec = sec;
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  message.pose.position = position;
  return message;
}

template <class Message>
std::vector<std::byte> cdr(const Message& message) {
  return ros::serialize(message);
}

template <class Message>
link::Payload payload_of(const Message& message) {
  const std::vector<std::byte> bytes = cdr(message);
  link::Payload payload{.memory = std::make_shared<std::byte[]>(bytes.size()),  // NOLINT
                        .size = bytes.size()};
  std::memcpy(payload.memory.get(), bytes.data(), bytes.size());
  return payload;
}

}  // namespace glidar::testing
