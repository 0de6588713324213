// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace glidar::link {

/// Which connections have subscribed to which topics, from the reports of ZeroMQ's XPUB socket. A
/// connection with several subscriptions is one subscriber.
class SubscriptionTable {
 public:
  /// For reports that do not name their connection: those of connections that ended.
  static constexpr int kUnknownConnection = -1;

  /// Returns how many subscriptions the connection has now. Without a connection each subscription
  /// counts as a subscriber of its own.
  std::size_t add(int connection, const std::string& topic);
  /// Without a connection any one that has this topic loses it: the one with the fewest topics.
  void remove(int connection, const std::string& topic);

  /// Connections that receive messages of at least one of these topics. A subscription receives all
  /// topics that begin with its own.
  [[nodiscard]] std::uint64_t subscribers(std::span<const std::string> topics) const;

 private:
  using Topics = std::map<std::string, std::uint64_t>;  ///< subscriptions of each

  struct Connection {
    Topics topics;
    std::size_t subscriptions = 0;  ///< of all topics
  };
  std::map<int, Connection> connections_;
};

}  // namespace glidar::link
