// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/ros/messages.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
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

}  // namespace glidar::ros
