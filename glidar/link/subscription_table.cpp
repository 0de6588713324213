// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/subscription_table.hpp>

#include <algorithm>
#include <iterator>

namespace glidar::link {
namespace {

bool begins_any(const std::string& begin, std::span<const std::string> topics) {
  return std::any_of(topics.begin(), topics.end(),
                     [&begin](const std::string& topic) { return topic.starts_with(begin); });
}

}  // namespace

std::size_t SubscriptionTable::add(const ConnectionId& connection, const std::string& topic) {
  Topics& topics = connections_[connection].topics;
  std::uint64_t& subscriptions = topics[topic];
  if (connection == kUnknownConnection || subscriptions == 0) ++subscriptions;
  return topics.size();
}

void SubscriptionTable::remove(const ConnectionId& connection, const std::string& topic) {
  auto found = connections_.find(connection);
  if (connection == kUnknownConnection &&
      (found == connections_.end() || found->second.topics.count(topic) == 0)) {
    const auto rank = [&topic](const auto& entry) {
      const Topics& topics = entry.second.topics;
      return topics.count(topic) == 0 ? topics.size() + 2 : topics.size();
    };
    found = std::min_element(connections_.begin(), connections_.end(),
                             [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  }
  if (found == connections_.end() || found->second.topics.count(topic) == 0) return;
  Topics& topics = found->second.topics;
  if (--topics[topic] == 0) topics.erase(topic);
  if (topics.empty()) connections_.erase(found);
}

std::uint64_t SubscriptionTable::subscribers(std::span<const std::string> topics) const {
  std::uint64_t count = 0;
  for (const auto& [connection, one] : connections_) {
    std::uint64_t wanted = 0;
    for (const auto& [topic, subscriptions] : one.topics) {
      if (begins_any(topic, topics)) wanted += subscriptions;
    }
    count += connection == kUnknownConnection ? wanted : std::min<std::uint64_t>(wanted, 1);
  }
  return count;
}

std::size_t SubscriptionTable::size() const {
  std::size_t count = 0;
  for (const auto& [connection, one] : connections_) count += one.topics.size();
  return count;
}

void SubscriptionTable::forget_ended(const std::function<bool(const ConnectionId&)>& is_open,
                                     Clock::time_point now) {
  for (auto one = connections_.begin(); one != connections_.end();) {
    const bool is_known = one->first != kUnknownConnection;
    // a connection without a cookie had ended when its subscription was read
    if (!is_known || (one->first.cookie != 0 && is_open(one->first))) {
      ++one;
      continue;
    }
    if (!one->second.ended) one->second.ended = now;
    one = now - *one->second.ended >= kEnd ? connections_.erase(one) : std::next(one);
  }
}

}  // namespace glidar::link
