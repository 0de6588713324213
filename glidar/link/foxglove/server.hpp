// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/foxglove/protocol.hpp>
#include <glidar/link/http_guard.hpp>
#include <glidar/link/payload.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace glidar::foxglove {

/// Limits of clients. Those beyond a limit are refused or disconnected; the stream continues.
struct ServerLimits {
  link::HttpLimits http = {};
  std::size_t clients = 32;                            ///< WebSocket connections
  std::size_t received_bytes = std::size_t{64} << 10;  ///< of one message
  std::size_t picks = 8;                               ///< that wait for their explanation
  std::chrono::milliseconds idle{120'000};             ///< without a byte or an answer to a ping
};

/// Receives the text that explains a point. May be called in any thread, once, also after the
/// server has ended. If all copies are destroyed without a call, the page reports that there is no
/// explanation.
using PickReply = std::function<void(const std::string& text)>;

struct ServerOptions {
  link::Endpoint at = {.host = "127.0.0.1", .port = 8765};
  std::string name = "GLIDAR";
  link::AccessRules access = {};
  ServerLimits limits = {};
  /// Called in the server's thread when the user of the page plays, pauses or steps; must return
  /// quickly. Empty: the page shows no such buttons.
  std::function<void(PlaybackCommand)> on_playback = {};
  /// Called in the server's thread when the user selects a point; must return quickly, and passes
  /// the reply on to the thread that explains. Empty: points are not explained.
  std::function<void(const Pick&, PickReply)> on_pick = {};
};

/// A topic to publish.
struct ChannelOptions {
  std::string topic;
  std::string schema_name = {};  ///< e.g. "sensor_msgs/msg/PointCloud2"
  std::string schema = {};       ///< text of the message definition
  std::string encoding = "cdr";
  std::string schema_encoding = "ros2msg";
  /// Messages that wait for a slow client, from 1: it receives the newest ones.
  std::size_t depth = 1;
};

/// Totals since the start.
struct ServerCounts {
  std::uint64_t clients = 0;      ///< connected now
  std::uint64_t connections = 0;  ///< accepted
  std::uint64_t sent = 0;         ///< messages, to all clients
  std::uint64_t dropped = 0;      ///< messages that slow clients missed
};

/// Publishes messages to Foxglove, Lichtblick and the page, which a browser opens at the same port.
/// Runs in its own thread; a slow client never delays publish(). A new subscriber receives the
/// newest message of the channel at once. Thread-safe.
class FoxgloveServer {
 public:
  /// Listens. Throws Error if the port is in use, and in builds without Boost. The log must outlive
  /// it.
  FoxgloveServer(const ServerOptions& options, link::ErrorLog& errors);
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  /// Advertises a channel to all present and future clients.
  ChannelId add_channel(const ChannelOptions& options);
  /// Never blocks and copies no payload.
  void publish(ChannelId channel, std::uint64_t time_ns, link::Payload message);
  /// The time of the simulation, which clients show.
  void publish_time(std::uint64_t time_ns);
  /// The state that the page shows, if there is on_playback.
  void set_playback(const PlaybackState& state);
  /// Whether any client is subscribed, so that a message need not be encoded otherwise. Late
  /// subscribers then wait for the next message.
  [[nodiscard]] bool is_subscribed(ChannelId channel) const;

  /// The port at which it listens.
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] ServerCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// False in builds without Boost.
bool has_foxglove_server();

}  // namespace glidar::foxglove
