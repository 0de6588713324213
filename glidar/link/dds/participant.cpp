// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/participant.hpp>

#include <glidar/link/dds/endpoint.hpp>
#include <glidar/link/dds/local_sockets.hpp>

#include <dds/dds.h>

#include <string_view>

namespace glidar::dds {

bool has_dds() {
  return true;
}

Participant::Participant(const DomainOptions& options, link::ErrorLog& errors)
    : errors_(errors), id_(domain_id(options)), sink_(errors) {
  const std::string where = "ROS domain " + std::to_string(id_);
  domain_handle_ = dds_create_domain(id_, domain_config(options).c_str());
  const bool is_first = domain_handle_ != DDS_RETCODE_PRECONDITION_NOT_MET;
  if (is_first) checked(domain_handle_, where, "cannot be joined");
  const QosPointer qos(dds_create_qos(), dds_delete_qos);
  // rmw_dds_common: the enclave of nodes without security.
  constexpr std::string_view kEnclave = "enclave=/;";
  dds_qset_userdata(qos.get(), kEnclave.data(), kEnclave.size());
  dds_qset_entity_name(qos.get(), "glidar");
  const std::int32_t participant = dds_create_participant(id_, qos.get(), nullptr);
  if (participant < 0 && is_first) dds_delete(domain_handle_);
  handle_ = checked(participant, where, "cannot be joined");
  if (options.interface_name == kLoopbackInterface && !accept_only(local_addresses(), id_)) {
    errors_.report("ROS 2", "the system does not keep packets of other machines from its ports");
  }
  const std::optional<std::size_t> limit = socket_buffer_limit();
  const std::string advice = limit ? socket_buffer_advice(*limit) : "";
  if (!advice.empty()) errors_.report("ROS 2", advice);
}

Participant::~Participant() {
  dds_delete(handle_);
  if (domain_handle_ >= 0) dds_delete(domain_handle_);
}

}  // namespace glidar::dds
