// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/endpoint.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/dds/serialized_type.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <fmt/format.h>

namespace glidar::dds {

std::int32_t checked(std::int32_t result, const std::string& where, const char* doing) {
  if (result >= 0) return result;
  throw Error({.where = where,
               .found = fmt::format("{}: {}", doing, dds_strretcode(result)),
               .remedy = "the warnings of Cyclone DDS give the reason"});
}

QosPointer endpoint_qos(const ros::MessageType& type, const ros::Qos& qos) {
  QosPointer pointer(dds_create_qos(), dds_delete_qos);
  dds_qos_t* to = pointer.get();
  const auto depth = static_cast<std::int32_t>(qos.depth);
  dds_qset_history(to, DDS_HISTORY_KEEP_LAST, depth);
  // A writer that keeps the last messages never waits, so the time does not matter.
  dds_qset_reliability(to, qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  if (qos.transient_local) {
    dds_qset_durability(to, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(to, 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(to, 1, &representation);
  dds_qset_writer_data_lifecycle(to, false);
  const std::string hash = fmt::format("typehash={};", type.type_hash);
  dds_qset_userdata(to, hash.data(), hash.size());
  return pointer;
}

Topic create_topic(const Participant& participant, const std::string& full_name,
                   const ros::MessageType& type, std::size_t max_received_bytes) {
  ddsi_sertype* known = new_serialized_type(ros::dds_type_name(type), max_received_bytes);
  const std::int32_t handle = dds_create_topic_sertype(
      participant.handle(), dds_topic_name(full_name).c_str(), &known, nullptr, nullptr, nullptr);
  if (handle < 0) ddsi_sertype_unref(known);
  return {checked(handle, "ROS topic " + full_name, "cannot be created"), known};
}

}  // namespace glidar::dds
