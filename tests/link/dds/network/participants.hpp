// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../pose_messages.hpp"
#include "free_domain.hpp"

#include <glidar/link/dds/participant.hpp>
#include <glidar/link/dds/topics.hpp>
#include "support/waiting.hpp"

#include <poll.h>

#include <chrono>
#include <string>

namespace glidar::testing {

/// Two participants of a domain of their own: of the program, and of others.
struct Participants {
  FreeDomain domain;
  link::ErrorLog errors{{}};
  dds::Participant ours{{.id = domain.id()}, errors};
  dds::Participant others{{.id = domain.id()}, errors};

  /// Whether an error of this kind was reported.
  [[nodiscard]] bool has_reported(const std::string& kind) const {
    return errors.counts().contains(kind);
  }
};

template <class Message>
dds::TopicWriter writer_of(const dds::Participant& participant, const std::string& topic) {
  const ros::MessageType& type = ros::message_type<Message>();
  return dds::TopicWriter(participant, topic, type, type.qos);
}

template <class Message>
dds::TopicReader reader_of(const dds::Participant& participant, const std::string& topic,
                           const dds::WakeUp& wake_up) {
  const ros::MessageType& type = ros::message_type<Message>();
  return dds::TopicReader(participant, {topic, type, type.qos}, wake_up);
}

inline bool is_matched(const dds::TopicWriter& writer) {
  return soon([&] { return writer.has_readers(); });
}

/// The first value that `receive` gives, waiting at the descriptor; empty after a long time.
template <class Receive>
auto wait_for(int descriptor, const Receive& receive) {
  const auto end = std::chrono::steady_clock::now() + kMaxWait;
  for (;;) {
    if (auto value = receive()) return value;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd entry{.fd = descriptor, .events = POLLIN, .revents = 0};
    if (left.count() <= 0 || poll(&entry, 1, static_cast<int>(left.count())) <= 0)
      return decltype(receive())();
  }
}

}  // namespace glidar::testing
