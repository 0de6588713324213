// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/error_log.hpp>
#include <glidar/link/socket.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glidar::link {

/// The destination of a reply.
struct ReturnAddress {
  std::string client;                      ///< identity of the connection
  std::vector<std::string> envelope = {};  ///< parts before the delimiter, which are returned
  ConnectionId connection = {};
};

/// A request of a client.
struct Delivered {
  ReturnAddress from;
  Message body;
  bool is_single = true;  ///< false: the body had more parts, which were discarded
};

/// Receives requests from any number of clients and replies to each in any order. A client is a
/// REQ socket, or a DEALER that sends an empty part, the delimiter, before each request; up to 8
/// short parts may precede it, such as the request number of ZMQ_REQ_CORRELATE. A message without
/// a delimiter is reported and discarded. Unlike ZeroMQ's REP, it has no state between request and
/// reply, so that no connection can affect the reply to another one.
/// Used by one thread at a time.
class Router {
 public:
  /// Sets the kind of the socket. The log must outlive it.
  Router(Context& context, SocketOptions options, ErrorLog& errors);

  void bind(const Endpoint& endpoint) { socket_.bind(endpoint); }
  /// The next request; empty if there is none now.
  std::optional<Delivered> receive();
  /// Never blocks.
  Sending reply(const ReturnAddress& to, std::span<const Part> parts);

  [[nodiscard]] Socket& socket() { return socket_; }
  [[nodiscard]] const Socket& socket() const { return socket_; }

 private:
  [[nodiscard]] std::optional<Delivered> read(const Message& identity);

  ErrorLog& errors_;
  Socket socket_;
};

/// A part that owns its bytes.
Part part_of(std::string bytes);

}  // namespace glidar::link
