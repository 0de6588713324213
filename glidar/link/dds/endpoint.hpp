// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/link/dds: what writers and readers of Cyclone DDS share.

#include <glidar/io/ros/message_types.hpp>
#include <glidar/link/dds/participant.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

struct dds_qos;
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

}  // namespace glidar::dds
