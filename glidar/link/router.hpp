// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/fault_log.hpp>
#include <glidar/link/socket.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::link {

/// Where a reply goes.
struct ReturnAddress {
  std::string client;                      ///< identity of the connection
  std::vector<std::string> envelope = {};  ///< parts before the delimiter, which come back
  ConnectionId connection = {};
};

/// What a client sent.
struct Delivered {
  ReturnAddress from;
  Message body;
  bool is_single = true;  ///< false: the body has more parts, which were discarded
};

/// Receives requests from any number of clients and replies to each in any order. A client is a
/// REQ socket, or a DEALER that sends an empty part, the delimiter, before each request; up to 8
/// short parts may precede it, such as the request number of ZMQ_REQ_CORRELATE. A message without
/// a delimiter is reported and discarded. Unlike ZeroMQ's REP, it holds no state of its own between
/// request and reply, so that no connection can affect the reply to another one.
/// Used by one thread at a time.
class Router {
 public:
  /// The log must outlive it. The kind of the socket is set.
  Router(Context& context, SocketOptions options, FaultLog& faults);

  void bind(const Endpoint& endpoint) { socket_.bind(endpoint); }
  /// The next request; nothing: there is none now.
  std::optional<Delivered> receive();
  /// Never waits.
  Sending reply(const ReturnAddress& to, std::span<const Part> parts);

  [[nodiscard]] Socket& socket() { return socket_; }
  [[nodiscard]] const Socket& socket() const { return socket_; }

 private:
  [[nodiscard]] std::optional<Delivered> read(const Message& identity);

  FaultLog& faults_;
  Socket socket_;
};

/// Bytes that keep themselves.
Part part_of(std::string bytes);

}  // namespace glidar::link
