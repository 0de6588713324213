// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/topic_reader.hpp>

#include <glidar/link/dds/endpoint.hpp>
#include <glidar/link/dds/serialized_type.hpp>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <memory>

namespace glidar::dds {
namespace {

void on_data(dds_entity_t /*reader*/, void* wake_up) {
  static_cast<const WakeUp*>(wake_up)->signal();
}

}  // namespace

TopicReader::TopicReader(const Participant& participant, const ReaderOptions& options,
                         const WakeUp& wake_up) {
  topic_ =
      create_topic(participant, options.full_name, options.type, options.max_message_bytes).handle;
  const QosPointer qos = endpoint_qos(options.type, options.qos);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(
      dds_create_listener(const_cast<WakeUp*>(&wake_up)), dds_delete_listener);
  dds_lset_data_available(listener.get(), on_data);
  const std::int32_t reader =
      dds_create_reader(participant.handle(), topic_, qos.get(), listener.get());
  if (reader < 0) dds_delete(topic_);
  handle_ = checked(reader, "ROS topic " + options.full_name, "cannot be read");
}

TopicReader::~TopicReader() {
  dds_delete(handle_);
  dds_delete(topic_);
}

std::optional<link::Payload> TopicReader::take() {
  constexpr std::uint32_t kAnyState = DDS_ANY_STATE;
  for (;;) {
    ddsi_serdata* message = nullptr;
    dds_sample_info_t info{};
    if (dds_takecdr(handle_, &message, 1, &info, kAnyState) != 1) return std::nullopt;
    link::Payload payload = payload_of(*message);
    ddsi_serdata_unref(message);
    if (info.valid_data) return payload;  // otherwise its writer has ended
  }
}

}  // namespace glidar::dds
