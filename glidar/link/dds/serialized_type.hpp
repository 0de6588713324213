// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/link/dds: the types of topics as Cyclone DDS sees them. Messages are serialized
// before they are written and deserialized after they are read, so that one codec (glidar/io/ros)
// serves files and networks. The types carry no type information of XTypes: Cyclone DDS 0.10.2
// crashes when a reader announces that of a newer implementation.

#include <glidar/link/payload.hpp>

#include <cstddef>
#include <string>

struct ddsi_serdata;
struct ddsi_sertype;

namespace glidar::dds {

/// A type without keys in XCDR1. Received messages above `max_received_bytes` are discarded.
/// The caller gives it to dds_create_topic_sertype().
ddsi_sertype* new_serialized_type(const std::string& type_name, std::size_t max_received_bytes);

/// A message of this type: CDR with its header of 4 bytes. Copies no bytes; the memory is released
/// after all readers have acknowledged it. The caller gives it to dds_writecdr().
ddsi_serdata* new_serialized_message(const ddsi_sertype& type, const link::Payload& message);

/// The bytes of a message, shared with it.
link::Payload payload_of(const ddsi_serdata& message);

}  // namespace glidar::dds
