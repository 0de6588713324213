// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/publications.hpp>

#include <glidar/link/dds/topic_names.hpp>
#include <glidar/link/dds/topics.hpp>

#include <dds/dds.h>

#include <algorithm>
#include <memory>

namespace glidar::dds {
namespace {

void on_publication(dds_entity_t /*reader*/, void* wake_up) {
  static_cast<const WakeUp*>(wake_up)->signal();
}

Publication publication_of(const dds_builtintopic_endpoint_t& endpoint) {
  Publication publication{.type_name = endpoint.type_name};
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_duration_t unused = 0;
  dds_qget_reliability(endpoint.qos, &reliability, &unused);
  publication.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_qget_durability(endpoint.qos, &durability);
  publication.transient_local = durability >= DDS_DURABILITY_TRANSIENT_LOCAL;
  return publication;
}

}  // namespace

Publications::Publications(const Participant& participant, const WakeUp& wake_up)
    : participant_(participant.handle()) {
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(
      dds_create_listener(const_cast<WakeUp*>(&wake_up)), dds_delete_listener);
  dds_lset_data_available(listener.get(), on_publication);
  handle_ = checked(dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION,
                                      nullptr, listener.get()),
                    "ROS domain " + std::to_string(participant.domain()),
                    "its publishers cannot be listed");
}

Publications::~Publications() {
  dds_delete(handle_);
}

std::vector<Publication> Publications::of(const std::string& full_name) const {
  constexpr std::size_t kMaxSeen = 10'000;
  const std::string name = dds_topic_name(full_name);
  dds_guid_t own{};
  dds_get_guid(participant_, &own);
  std::vector<Publication> found;
  std::vector<void*> samples(kMaxSeen);
  std::vector<dds_sample_info_t> infos(kMaxSeen);
  const dds_return_t count =
      dds_read_mask(handle_, samples.data(), infos.data(), kMaxSeen, kMaxSeen,
                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (dds_return_t i = 0; i < count; ++i) {
    const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    const bool is_own = std::ranges::equal(endpoint.participant_key.v, own.v);
    if (infos[i].valid_data && !is_own && endpoint.topic_name == name)
      found.push_back(publication_of(endpoint));
  }
  if (count > 0) dds_return_loan(handle_, samples.data(), count);
  return found;
}

}  // namespace glidar::dds
