// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/connection_guard.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace glidar::link {

/// The topics of every connection, from the reports of ZeroMQ's XPUB socket. A connection with
/// several subscriptions is one subscriber. A second subscription to the same topic changes
/// nothing, because ZeroMQ reports only one end of both.
class SubscriptionTable {
 public:
  using Clock = std::chrono::steady_clock;

  /// For reports without a connection, i.e. those of connections that have ended.
  static constexpr ConnectionId kUnknownConnection = {};

  /// Returns the number of the connection's subscriptions. Without a connection, each subscription
  /// counts as a subscriber.
  std::size_t add(const ConnectionId& connection, const std::string& topic);
  /// Without a connection, the topic is removed from the connection with the fewest topics.
  void remove(const ConnectionId& connection, const std::string& topic);

  /// Connections that receive messages of at least one of these topics. A subscription receives all
  /// topics that begin with its own.
  [[nodiscard]] std::uint64_t subscribers(std::span<const std::string> topics) const;
  /// Subscriptions of all connections.
  [[nodiscard]] std::size_t size() const;

  /// To be called when there are no more reports. Remaining topics of a connection that ended kEnd
  /// ago were reported twice: with its number, and after the end with none or another one.
  void forget_ended(const std::function<bool(const ConnectionId&)>& is_open, Clock::time_point now);
  /// Time after which ZeroMQ has reported the end of all subscriptions of a connection.
  static constexpr std::chrono::seconds kEnd{10};

 private:
  using Topics =
      std::map<std::string, std::uint64_t>;  ///< number of subscriptions; 1 for a known connection

  struct Connection {
    Topics topics;
    std::optional<Clock::time_point> ended;
  };
  std::map<ConnectionId, Connection> connections_;
};

}  // namespace glidar::link
