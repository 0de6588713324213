// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/participant.hpp>

#include <glidar/core/text.hpp>
#include <glidar/link/dds/domain.hpp>
#include <glidar/link/dds/topics.hpp>

#include <dds/dds.h>
#include <dds/ddsrt/log.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <string_view>
#include <vector>

namespace glidar::dds {
namespace {

struct Logs {
  std::mutex mutex;
  std::vector<link::ErrorLog*> all;
};

/// Of the process, as the destination in Cyclone DDS.
Logs& logs() {
  static Logs instance;
  return instance;
}

void forward(void* /*unused*/, const dds_log_data_t* data) {
  if ((data->priority & (DDS_LC_FATAL | DDS_LC_ERROR | DDS_LC_WARNING)) == 0U) return;
  std::string_view text(data->message, data->size);
  while (text.ends_with('\n') || text.ends_with('\0')) text.remove_suffix(1);
  try {
    const std::lock_guard lock(logs().mutex);
    for (link::ErrorLog* log : logs().all) log->report("Cyclone DDS", excerpt(text));
  } catch (const std::exception&) {  // out of memory: the caller is in C
    return;
  }
}

}  // namespace

LogSink::LogSink(link::ErrorLog& log) : log_(log) {
  {
    const std::lock_guard lock(logs().mutex);
    logs().all.push_back(&log_);
  }
  dds_set_log_sink(forward, nullptr);  // waits for calls of forward()
}

LogSink::~LogSink() {
  const std::lock_guard lock(logs().mutex);
  std::vector<link::ErrorLog*>& all = logs().all;
  all.erase(std::ranges::find(all, &log_));
}

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
