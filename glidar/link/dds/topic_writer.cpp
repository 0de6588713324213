// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/topic_writer.hpp>

#include <glidar/link/dds/endpoint.hpp>
#include <glidar/link/dds/serialized_type.hpp>

#include <dds/dds.h>

namespace glidar::dds {
namespace {

/// Only readers receive; a writer's type has a limit all the same.
constexpr std::size_t kMaxReceived_bytes = std::size_t{1} << 20;

}  // namespace

TopicWriter::TopicWriter(const Participant& participant, const std::string& full_name,
                         const ros::MessageType& type, const ros::Qos& qos)
    : errors_(participant.errors()), name_(full_name) {
  const Topic topic = create_topic(participant, full_name, type, kMaxReceived_bytes);
  topic_ = topic.handle;
  type_ = topic.type;
  const std::int32_t writer =
      dds_create_writer(participant.handle(), topic_, endpoint_qos(type, qos).get(), nullptr);
  if (writer < 0) dds_delete(topic_);
  handle_ = checked(writer, "ROS topic " + full_name, "cannot be written");
}

TopicWriter::~TopicWriter() {
  dds_delete(handle_);
  dds_delete(topic_);
}

bool TopicWriter::write(const link::Payload& message) {
  const dds_return_t result = dds_writecdr(handle_, new_serialized_message(*type_, message));
  if (result == DDS_RETCODE_OK) {
    ++count_;
    return true;
  }
  errors_.report("ROS topic " + name_,
                 std::string("a message was not sent: ") + dds_strretcode(result));
  return false;
}

bool TopicWriter::has_readers() const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(handle_, &status) == DDS_RETCODE_OK &&
         status.current_count > 0;
}

bool TopicWriter::wait_for_acknowledgements(std::chrono::milliseconds timeout) const {
  return dds_wait_for_acks(handle_, std::chrono::nanoseconds(timeout).count()) == DDS_RETCODE_OK;
}

}  // namespace glidar::dds
