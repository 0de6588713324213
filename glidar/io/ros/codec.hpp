// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/messages.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::ros {

/// How a message that is read is serialized.
enum class Wire : std::uint8_t {
  cdr,   ///< ROS 2: XCDR1, little-endian, behind its encapsulation header of 4 bytes. OMG DDSI-RTPS
         ///< 2.5, 10; OMG CORBA 3.3, part 2, 9.3 (CDR); alignment counts from behind the header
  ros1,  ///< ROS 1: packed, little-endian. wiki.ros.org/msg, "Fields"
};

/// The message as Wire::cdr, for all messages of messages.hpp but those that are only parts of
/// others. Throws Error when it would exceed 4 GiB.
template <class Message>
std::vector<std::byte> serialize(const Message& message);

/// The same, reusing the memory of `to`.
template <class Message>
void serialize_to(const Message& message, std::vector<std::byte>& to);

/// The message of these bytes. Throws Error unless they are one message of this type; the memory
/// that it takes is a small multiple of the size of `bytes`.
template <class Message>
Message deserialize(std::span<const std::byte> bytes, Wire wire = Wire::cdr);

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
