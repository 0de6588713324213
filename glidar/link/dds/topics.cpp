// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_keyhash.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <string_view>

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

namespace {

constexpr std::size_t kCdrHeader_bytes = 4;

struct Type : ddsi_sertype {
  std::size_t max_received_bytes = 0;
};

struct Message : ddsi_serdata {
  Message(const ddsi_sertype* its_type, ddsi_serdata_kind its_kind) : ddsi_serdata{} {
    ddsi_serdata_init(this, its_type, its_kind);
    hash = its_type->serdata_basehash;
  }
  link::Payload payload;
};

const Message& message_of(const ddsi_serdata* data) {
  return *static_cast<const Message*>(data);
}

/// Cyclone DDS is written in C, so no exception may reach it: nullptr means that there is no
/// message.
template <class Make>
ddsi_serdata* guarded(const Make& make) {
  try {
    return make();
  } catch (const std::exception&) {
    return nullptr;
  }
}

/// Memory for a received message; nullptr if it is too large, or smaller than a header.
std::unique_ptr<Message> allocate(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                  std::size_t size) {
  const auto* known = static_cast<const Type*>(type);
  if (size > known->max_received_bytes || size < kCdrHeader_bytes) return nullptr;
  auto message = std::make_unique<Message>(type, kind);
  // not make_shared, which writes zeros before, and visits every byte at the end
  message->payload = {.memory = std::shared_ptr<std::byte[]>(new std::byte[size]),  // NOLINT
                      .size = size};
  return message;
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  return guarded([&]() -> ddsi_serdata* {
    std::unique_ptr<Message> message = allocate(type, kind, size);
    if (!message) return nullptr;
    std::size_t end = 0;  // fragments may overlap
    for (; fragment != nullptr; fragment = fragment->nextfrag) {
      if (fragment->maxp1 <= end) continue;
      if (fragment->min > end || fragment->maxp1 > size) return nullptr;
      const unsigned char* bytes =
          NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
      std::memcpy(message->payload.memory.get() + end, bytes + (end - fragment->min),
                  fragment->maxp1 - end);
      end = fragment->maxp1;
    }
    return end == size ? message.release() : nullptr;
  });
}

ddsi_serdata* from_vectors(const ddsi_sertype* type, ddsi_serdata_kind kind,
                           ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* vectors,
                           std::size_t size) {
  return guarded([&]() -> ddsi_serdata* {
    std::unique_ptr<Message> message = allocate(type, kind, size);
    if (!message) return nullptr;
    std::size_t end = 0;
    for (ddsrt_msg_iovlen_t i = 0; i < count && end < size; ++i) {
      const std::size_t part = std::min<std::size_t>(vectors[i].iov_len, size - end);
      std::memcpy(message->payload.memory.get() + end, vectors[i].iov_base, part);
      end += part;
    }
    return end == size ? message.release() : nullptr;
  });
}

ddsi_serdata* key_of(const ddsi_sertype* type) {
  return guarded([&] { return new Message(type, SDK_KEY); });
}

ddsi_serdata* from_keyhash(const ddsi_sertype* type, const ddsi_keyhash* /*keyhash*/) {
  return key_of(type);
}

/// Only serialized messages are written.
ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* /*data*/) {
  return kind == SDK_KEY ? key_of(type) : nullptr;
}

ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  ddsi_serdata* key = key_of(data->type);
  if (key != nullptr) key->type = nullptr;
  return key;
}

std::uint32_t size_of(const ddsi_serdata* data) {
  return static_cast<std::uint32_t>(
      std::max(message_of(data).payload.size, kCdrHeader_bytes));  // also of a key
}

/// Up to three bytes behind the end are padding.
void copy_bytes(const ddsi_serdata* data, std::size_t begin, std::size_t size, void* to) {
  const link::Payload& payload = message_of(data).payload;
  const std::size_t left = payload.size - std::min(begin, payload.size);
  const std::size_t copied = std::min(size, left);
  if (copied > 0) std::memcpy(to, payload.memory.get() + begin, copied);
  std::memset(static_cast<std::byte*>(to) + copied, 0, size - copied);
}

bool is_inside(const link::Payload& payload, const void* place) {
  const std::less<const void*> before;
  const std::byte* begin = payload.memory.get();
  return begin != nullptr && !before(place, begin) && before(place, begin + payload.size);
}

/// Refers to the payload itself, except for a last part with padding.
ddsi_serdata* refer(const ddsi_serdata* data, std::size_t begin, std::size_t size,
                    ddsrt_iovec_t* reference) {
  const link::Payload& payload = message_of(data).payload;
  if (begin + size <= payload.size) {
    reference->iov_base = payload.memory.get() + begin;
  } else {
    reference->iov_base = new std::byte[size];
    copy_bytes(data, begin, size, reference->iov_base);
  }
  reference->iov_len = size;
  return ddsi_serdata_ref(data);
}

void stop_referring(ddsi_serdata* data, const ddsrt_iovec_t* reference) {
  if (!is_inside(message_of(data).payload, reference->iov_base)) {
    delete[] static_cast<std::byte*>(reference->iov_base);
  }
  ddsi_serdata_unref(data);
}

bool to_sample(const ddsi_serdata* /*data*/, void* /*sample*/, void** /*buffer*/, void* /*limit*/) {
  return false;
}

bool untyped_to_sample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*data*/, void* /*sample*/,
                       void** /*buffer*/, void* /*limit*/) {
  return true;
}

bool are_equal_keys(const ddsi_serdata* /*a*/, const ddsi_serdata* /*b*/) {
  return true;
}

void free_message(ddsi_serdata* data) {
  delete static_cast<Message*>(data);
}

std::size_t print_message(const ddsi_sertype* /*type*/, const ddsi_serdata* /*data*/, char* to,
                          std::size_t size) {
  constexpr std::string_view kText = "(serialized)";
  const std::size_t copied = std::min(size - 1, kText.size());
  std::copy_n(kText.begin(), copied, to);
  to[copied] = '\0';
  return copied;
}

void get_keyhash(const ddsi_serdata* /*data*/, ddsi_keyhash* to, bool /*force_md5*/) {
  *to = {};
}

constexpr ddsi_serdata_ops kMessageOperations = {
    .eqkey = are_equal_keys,
    .get_size = size_of,
    .from_ser = from_fragments,
    .from_ser_iov = from_vectors,
    .from_keyhash = from_keyhash,
    .from_sample = from_sample,
    .to_ser = copy_bytes,
    .to_ser_ref = refer,
    .to_ser_unref = stop_referring,
    .to_sample = to_sample,
    .to_untyped = to_untyped,
    .untyped_to_sample = untyped_to_sample,
    .free = free_message,
    .print = print_message,
    .get_keyhash = get_keyhash,
#ifdef DDS_HAS_SHM
    .get_sample_size = nullptr,
    .from_iox_buffer = nullptr,
#endif
};

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<Type*>(type);
}

void zero_samples(const ddsi_sertype* /*type*/, void* /*samples*/, std::size_t /*count*/) {}

void realloc_samples(void** samples, const ddsi_sertype* /*type*/, void* /*old*/,
                     std::size_t /*old_count*/, std::size_t count) {
  std::fill_n(samples, count, nullptr);
}

void free_samples(const ddsi_sertype* /*type*/, void** /*samples*/, std::size_t /*count*/,
                  dds_free_op_t /*operation*/) {}

bool are_equal_types(const ddsi_sertype* a, const ddsi_sertype* b) {
  return static_cast<const Type*>(a)->max_received_bytes ==
         static_cast<const Type*>(b)->max_received_bytes;
}

std::uint32_t hash_of(const ddsi_sertype* type) {
  return static_cast<std::uint32_t>(static_cast<const Type*>(type)->max_received_bytes);
}

constexpr ddsi_sertype_ops kTypeOperations = {
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free = free_type,
    .zero_samples = zero_samples,
    .realloc_samples = realloc_samples,
    .free_samples = free_samples,
    .equal = are_equal_types,
    .hash = hash_of,
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

}  // namespace

ddsi_sertype* new_serialized_type(const std::string& type_name, std::size_t max_received_bytes) {
  auto type = std::make_unique<Type>();
  ddsi_sertype_init_flags(type.get(), type_name.c_str(), &kTypeOperations, &kMessageOperations,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  type->max_received_bytes = max_received_bytes;
  return type.release();
}

ddsi_serdata* new_serialized_message(const ddsi_sertype& type, const link::Payload& message) {
  auto data = std::make_unique<Message>(&type, SDK_DATA);
  data->payload = message;
  return data.release();
}

link::Payload payload_of(const ddsi_serdata& message) {
  return static_cast<const Message&>(message).payload;
}

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
