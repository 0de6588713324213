// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/subscription_table.hpp>

#include <algorithm>

namespace glidar::link {
namespace {

bool begins_any(const std::string& begin, std::span<const std::string> topics) {
  return std::any_of(topics.begin(), topics.end(),
                     [&begin](const std::string& topic) { return topic.starts_with(begin); });
}

}  // namespace

std::size_t SubscriptionTable::add(int connection, const std::string& topic) {
  Connection& subscriber = connections_[connection];
  ++subscriber.topics[topic];
  return ++subscriber.subscriptions;
}

void SubscriptionTable::remove(int connection, const std::string& topic) {
  auto found = connections_.find(connection);
  if (connection == kUnknownConnection &&
      (found == connections_.end() || found->second.topics.count(topic) == 0)) {
    // a connection's number may be used again before the end of the first one is reported, so the
    // one that has the topic twice goes first
    const auto rank = [&topic](const auto& entry) {
      const Topics& topics = entry.second.topics;
      const auto subscriptions = topics.find(topic);
      if (subscriptions == topics.end()) return topics.size() + 2;
      return subscriptions->second > 1 ? std::size_t{0} : topics.size();
    };
    found = std::min_element(connections_.begin(), connections_.end(),
                             [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  }
  if (found == connections_.end() || found->second.topics.count(topic) == 0) return;
  Topics& topics = found->second.topics;
  --found->second.subscriptions;
  if (--topics[topic] == 0) topics.erase(topic);
  if (topics.empty()) connections_.erase(found);
}

std::uint64_t SubscriptionTable::subscribers(std::span<const std::string> topics) const {
  std::uint64_t count = 0;
  for (const auto& [connection, subscriber] : connections_) {
    std::uint64_t wanted = 0;
    for (const auto& [topic, subscriptions] : subscriber.topics) {
      if (begins_any(topic, topics)) wanted += subscriptions;
    }
    count += connection == kUnknownConnection ? wanted : std::min<std::uint64_t>(wanted, 1);
  }
  return count;
}

}  // namespace glidar::link
