// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/participant.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/link/dds/domain.hpp>
#include <glidar/link/dds/pose_decoder.hpp>
#include <glidar/link/dds/topic_names.hpp>
#include <glidar/link/dds/topics.hpp>

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
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

namespace {

constexpr ros::Qos kTransformQos = {.depth = 100};  // of tf2_ros::TransformListener
constexpr ros::Qos kStaticQos = {.transient_local = true, .depth = 100};

/// Poses that wait in a reader, so that none of a busy publisher is lost while a frame is measured.
constexpr std::uint32_t kPoseDepth = 1000;

/// The supported type of this name in DDS; nullptr if there is none.
const ros::MessageType* pose_type(const std::string& dds_name) {
  const std::array types = {&ros::message_type<ros::Odometry>(),
                            &ros::message_type<ros::PoseStamped>()};
  const auto found = std::ranges::find_if(
      types, [&](const ros::MessageType* type) { return ros::dds_type_name(*type) == dds_name; });
  return found == types.end() ? nullptr : *found;
}

}  // namespace

struct PoseSubscriber::Impl {
  Impl(const Participant& its_participant, const PoseTopic& its_topic, std::size_t its_queue)
      : participant(its_participant), topic(its_topic), queue(its_queue) {
    const ros::MessageType& transforms = ros::message_type<ros::TFMessage>();
    if (topic.parent_frame.empty()) {
      publications.emplace(participant, wake_up);
      return;
    }
    type = &transforms;
    reader.emplace(participant, ReaderOptions{topic.name, transforms, kTransformQos}, wake_up);
    static_reader.emplace(participant,
                          ReaderOptions{topic.name + "_static", transforms, kStaticQos}, wake_up);
  }

  void find_publisher();
  void decode(TopicReader& from, bool is_static);
  void take(const std::vector<FramedPose>& received, bool is_static);
  void push(const TimedPose& pose);

  const Participant& participant;
  PoseTopic topic;
  std::size_t queue = 0;
  WakeUp wake_up;
  std::optional<Publications> publications;  ///< until the type is known
  const ros::MessageType* type = nullptr;
  std::optional<TopicReader> reader;
  std::optional<TopicReader> static_reader;
  TransformTree tree;
  std::optional<std::int64_t> last_ns;  ///< of transforms
  std::deque<TimedPose> poses;
  PoseCounts counts;
};

/// Subscribes to the topic as soon as its type is known, with the QoS of its publisher.
void PoseSubscriber::Impl::find_publisher() {
  for (const Publication& publication : publications->of(topic.name)) {
    type = pose_type(publication.type_name);
    if (type == nullptr) {
      participant.errors().report(
          "ROS topic " + topic.name,
          fmt::format("has the type {}; allowed: nav_msgs/msg/Odometry and "
                      "geometry_msgs/msg/PoseStamped, or transforms as /tf:PARENT:CHILD",
                      publication.type_name));
      continue;
    }
    const ros::Qos qos = {.reliable = publication.reliable,
                          .transient_local = publication.transient_local,
                          .depth = kPoseDepth};
    reader.emplace(participant, ReaderOptions{topic.name, *type, qos}, wake_up);
    publications.reset();
    return;
  }
}

void PoseSubscriber::Impl::decode(TopicReader& from, bool is_static) {
  while (const std::optional<link::Payload> message = from.take()) {
    ++counts.received;
    try {
      take(decode_poses(*type, message->bytes()), is_static);
    } catch (const Error& error) {
      ++counts.invalid;
      participant.errors().report("pose of ROS topic " + topic.name, error.what());
    }
  }
}

void PoseSubscriber::Impl::take(const std::vector<FramedPose>& received, bool is_static) {
  if (topic.parent_frame.empty()) {
    for (const FramedPose& framed : received) push(framed.pose);
    return;
  }
  for (const FramedPose& framed : received) {
    if (!tree.set(framed, is_static)) {
      participant.errors().report("transforms of ROS topic " + topic.name,
                                  "a frame is its own parent, or there are too many frames");
    }
  }
  const std::optional<TimedPose> found = tree.find(topic.parent_frame, topic.child_frame);
  if (!found || std::exchange(last_ns, found->t_ns) == found->t_ns) return;
  push(*found);
}

void PoseSubscriber::Impl::push(const TimedPose& pose) {
  poses.push_back(pose);
  while (poses.size() > std::max<std::size_t>(queue, 1)) {
    poses.pop_front();
    ++counts.skipped;
  }
}

PoseSubscriber::PoseSubscriber(const Participant& participant, const PoseTopic& topic,
                               std::size_t queue)
    : impl_(std::make_unique<Impl>(participant, topic, queue)) {}

PoseSubscriber::~PoseSubscriber() = default;

std::optional<TimedPose> PoseSubscriber::receive() {
  impl_->wake_up.clear();
  if (impl_->publications) impl_->find_publisher();
  if (impl_->static_reader) impl_->decode(*impl_->static_reader, true);
  if (impl_->reader) impl_->decode(*impl_->reader, false);
  if (impl_->poses.empty()) return std::nullopt;
  const TimedPose pose = impl_->poses.front();
  impl_->poses.pop_front();
  return pose;
}

int PoseSubscriber::descriptor() const {
  return impl_->wake_up.descriptor();
}

PoseCounts PoseSubscriber::counts() const {
  return impl_->counts;
}

namespace {

constexpr ros::Qos kClockQos = {.reliable = false, .depth = 1};  // of rclcpp::ClockQoS

}  // namespace

struct ClockSubscriber::Impl {
  explicit Impl(const Participant& its_participant)
      : participant(its_participant),
        reader(participant, ReaderOptions{"/clock", ros::message_type<ros::Clock>(), kClockQos},
               wake_up) {}

  const Participant& participant;
  WakeUp wake_up;
  TopicReader reader;
  PoseCounts counts;
};

ClockSubscriber::ClockSubscriber(const Participant& participant)
    : impl_(std::make_unique<Impl>(participant)) {}

ClockSubscriber::~ClockSubscriber() = default;

std::optional<std::int64_t> ClockSubscriber::receive() {
  impl_->wake_up.clear();
  std::optional<std::int64_t> newest;
  while (const std::optional<link::Payload> message = impl_->reader.take()) {
    ++impl_->counts.received;
    try {
      newest = decode_clock(message->bytes());
    } catch (const Error& error) {
      ++impl_->counts.invalid;
      impl_->participant.errors().report("time of ROS topic /clock", error.what());
    }
  }
  return newest;
}

int ClockSubscriber::descriptor() const {
  return impl_->wake_up.descriptor();
}

PoseCounts ClockSubscriber::counts() const {
  return impl_->counts;
}

}  // namespace glidar::dds
