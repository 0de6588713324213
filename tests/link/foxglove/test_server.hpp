// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/server.hpp>

#include "web_peers.hpp"

#include <cstddef>
#include <cstring>
#include <memory>
#include <string>

namespace glidar::testing {

inline link::Payload payload_of(const std::string& text) {
  link::Payload payload{.memory = std::make_shared<std::byte[]>(text.size()),  // NOLINT
                        .size = text.size()};
  std::memcpy(payload.memory.get(), text.data(), text.size());
  return payload;
}

/// A server at a free port with one channel.
struct TestServer {
  explicit TestServer(foxglove::ServerOptions options = {})
      : server((options.at.port = 0, options), errors) {
    channel = server.add_channel({.topic = "/points",
                                  .schema_name = "sensor_msgs/msg/PointCloud2",
                                  .schema = "uint8[] data\n"});
  }
  void publish(const std::string& text, std::uint64_t time_ns = 1) {
    server.publish(channel, time_ns, payload_of(text));
  }
  [[nodiscard]] std::uint16_t port() const { return server.port(); }
  /// Whether a new client can subscribe and receive.
  bool serves() {
    const WebSocketPeer client(port());
    client.subscribe(9, channel);
    publish("alive");
    while (client.message(9) != "alive") continue;  // an earlier message may come first
    return true;
  }

  link::ErrorLog errors{{}};
  foxglove::FoxgloveServer server;
  foxglove::ChannelId channel = 0;
};

}  // namespace glidar::testing
