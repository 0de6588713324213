// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/codec.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace glidar::ros {

/// Quality of service of a publisher: keep last `depth`.
struct Qos {
  bool reliable = true;
  bool transient_local = false;  ///< subscribers that come later get the last messages
  std::uint32_t depth = 10;
};

/// For /tf_static, which late subscribers must receive.
inline constexpr Qos kStaticTransformQos = {.transient_local = true, .depth = 1};

/// What ROS 1 and ROS 2 know of a type of message.
struct MessageType {
  std::string_view name;       ///< in ROS 2: sensor_msgs/msg/PointCloud2
  std::string_view ros1_name;  ///< sensor_msgs/PointCloud2
  /// REP-2016: RIHS01_ and 64 hexadecimal digits; the same in all distributions of ROS 2.
  std::string_view type_hash;
  Qos qos;  ///< default of a publisher
};

/// All types of codec.hpp.
std::span<const MessageType> message_types();

/// The type of one of the structs of messages.hpp that codec.hpp serializes.
template <class Message>
const MessageType& message_type();

// They are specializations, which every file must know before it uses one.
template <>
const MessageType& message_type<Header>();
template <>
const MessageType& message_type<PointField>();
template <>
const MessageType& message_type<PointCloud2>();
template <>
const MessageType& message_type<LaserScan>();
template <>
const MessageType& message_type<Image>();
template <>
const MessageType& message_type<CompressedImage>();
template <>
const MessageType& message_type<CameraInfo>();
template <>
const MessageType& message_type<Imu>();
template <>
const MessageType& message_type<TFMessage>();
template <>
const MessageType& message_type<PoseStamped>();
template <>
const MessageType& message_type<Clock>();
template <>
const MessageType& message_type<Odometry>();
template <>
const MessageType& message_type<CustomMsg>();
template <>
const MessageType& message_type<VelodyneScan>();
template <>
const MessageType& message_type<PacketMsg>();
template <>
const MessageType& message_type<String>();
template <>
const MessageType& message_type<MarkerArray>();

/// The type of this name in ROS 1 or ROS 2; nullptr if there is none. Accepts the CustomMsg of
/// livox_ros_driver too, which has the same definition.
const MessageType* find_message_type(std::string_view name);

/// The definition with those of all types in it, without comments, as MCAP's schema encoding
/// `ros2msg` and rosbag2 store it.
std::string definition_text(const MessageType& type);

/// The name of the type in DDS: sensor_msgs::msg::dds_::PointCloud2_.
std::string dds_type_name(const MessageType& type);

/// A QoS as rosbag2 stores it in metadata of version 8 and below.
std::string qos_yaml(const Qos& qos);

}  // namespace glidar::ros
