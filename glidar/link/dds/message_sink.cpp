// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/message_sink.hpp>

#include <glidar/core/text.hpp>
#include <glidar/link/dds/topic_names.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <string_view>
#include <utility>

namespace glidar::dds {
namespace {

/// Topics that all robots share.
constexpr std::array<std::string_view, 3> kGlobalTopics = {"/tf", "/tf_static", "/clock"};

/// Topics of which each publisher gives a part.
constexpr std::array<std::string_view, 2> kSharedTopics = {"/tf", "/tf_static"};

}  // namespace

MessageSink::MessageSink(const Participant& participant, MessageSinkOptions options)
    : participant_(participant),
      options_(std::move(options)),
      others_(participant, publisher_appeared_) {
  (void)full_topic_name("topic", options_.ros_namespace);
}

std::size_t MessageSink::add_topic(const ros::Topic& topic) {
  std::unique_ptr<TopicWriter> writer;
  if (std::ranges::find(options_.omitted, topic.name) == options_.omitted.end()) {
    const bool is_global = std::ranges::find(kGlobalTopics, topic.name) != kGlobalTopics.end();
    const std::string name =
        is_global ? topic.name : full_topic_name(topic.name.substr(1), options_.ros_namespace);
    writer = std::make_unique<TopicWriter>(participant_, name, *topic.type, topic.qos);
  }
  writers_.push_back(std::move(writer));
  is_kept_.push_back(topic.qos.transient_local);
  return writers_.size() - 1;
}

bool MessageSink::is_wanted(std::size_t topic) const {
  return writers_[topic] && (is_kept_[topic] || writers_[topic]->has_readers());
}

void MessageSink::write(std::size_t topic, std::int64_t /*time_ns*/,
                        std::span<const std::byte> message) {
  if (!is_wanted(topic)) return;
  link::Payload payload = memory_.take(message.size());
  std::memcpy(payload.memory.get(), message.data(), message.size());
  writers_[topic]->write(payload);
}

void MessageSink::take(std::size_t topic, std::int64_t time_ns, std::vector<std::byte>& message) {
  if (message.size() < kMinReused_bytes) return write(topic, time_ns, message);
  if (is_wanted(topic)) writers_[topic]->write(memory_.take(message));
}

void MessageSink::finish() {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  for (const std::unique_ptr<TopicWriter>& writer : writers_) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (writer && left.count() > 0) (void)writer->wait_for_acknowledgements(left);
  }
}

void MessageSink::report_other_publishers() {
  if (!publisher_appeared_.clear()) return;
  std::vector<std::string> contested;
  for (const std::unique_ptr<TopicWriter>& writer : writers_) {
    if (!writer || std::ranges::find(kSharedTopics, writer->name()) != kSharedTopics.end())
      continue;
    if (!others_.of(writer->name()).empty()) contested.push_back(writer->name());
  }
  if (contested.size() > contested_.size()) {
    // A kind of its own: advice for the participant may just have been printed
    participant_.errors().report("ROS 2 topics",
                                 "another program also publishes " + comma_separated(contested) +
                                     ", so nodes receive both; end it, or use another "
                                     "ROS_DOMAIN_ID");
  }
  contested_ = std::move(contested);
}

std::uint64_t MessageSink::count() const {
  std::uint64_t count = 0;
  for (const std::unique_ptr<TopicWriter>& writer : writers_) count += writer ? writer->count() : 0;
  return count;
}

}  // namespace glidar::dds
