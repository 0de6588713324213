// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/subscribers.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/dds/pose_decoder.hpp>
#include <glidar/link/dds/publications.hpp>
#include <glidar/link/dds/topics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <utility>

namespace glidar::dds {
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
