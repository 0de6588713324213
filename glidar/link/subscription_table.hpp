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

/// Which connections have subscribed to which topics, from the reports of ZeroMQ's XPUB socket. A
/// connection with several subscriptions is one subscriber. Its second subscription to the same
/// topic changes nothing, because ZeroMQ reports only one end of both.
class SubscriptionTable {
 public:
  using Clock = std::chrono::steady_clock;

  /// For reports that do not name their connection: those of connections that ended.
  static constexpr ConnectionId kUnknownConnection = {};

  /// Returns how many subscriptions the connection has now. Without a connection each subscription
  /// counts as a subscriber of its own.
  std::size_t add(const ConnectionId& connection, const std::string& topic);
  /// Without a connection any one that has this topic loses it: the one with the fewest topics.
  void remove(const ConnectionId& connection, const std::string& topic);

  /// Connections that receive messages of at least one of these topics. A subscription receives all
  /// topics that begin with its own.
  [[nodiscard]] std::uint64_t subscribers(std::span<const std::string> topics) const;
  /// Subscriptions of all connections.
  [[nodiscard]] std::size_t size() const;

  /// To be called when there are no more reports. What is left of a connection that ended kEnd ago
  /// was reported twice: once under its number, and once after the end, under no or another one.
  void forget_ended(const std::function<bool(const ConnectionId&)>& is_open, Clock::time_point now);
  /// By then ZeroMQ has reported the end of all its subscriptions.
  static constexpr std::chrono::seconds kEnd{10};

 private:
  using Topics = std::map<std::string, std::uint64_t>;  ///< subscriptions; 1 of a known connection

  struct Connection {
    Topics topics;
    std::optional<Clock::time_point> ended;
  };
  std::map<ConnectionId, Connection> connections_;
};

}  // namespace glidar::link
