// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/fault_log.hpp>
#include <glidar/link/lockstep/messages.hpp>
#include <glidar/link/socket.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glidar::lockstep {

struct ServerOptions {
  link::Endpoint endpoint = {.host = "127.0.0.1"};
  std::optional<link::CurveKeys> curve = {};  ///< empty: not encrypted
};

/// A measured cloud on its way to the client.
struct CloudReply {
  CloudHead head;
  std::shared_ptr<const PointCloud> cloud;  ///< kept until it is sent
};

/// Takes requests, one after the other, from any number of clients. Every request that is received
/// is to be replied to, once. Used by one thread.
class Server {
 public:
  /// Listens. Throws Error. The context and the log must outlive it.
  Server(link::Context& context, const ServerOptions& options, link::FaultLog& faults);

  /// The next request; nothing: there is none now. What is no request is replied to with an error.
  std::optional<Request> receive();

  void reply(std::uint64_t id, std::span<const CloudReply> clouds);
  void reply_error(std::uint64_t id, std::string_view text);
  void reply_description(std::uint64_t id, std::string_view json);

  [[nodiscard]] const link::Socket& socket() const { return socket_; }

  struct Counts {
    std::uint64_t received = 0;
    std::uint64_t refused = 0;  ///< of these, with an error
    std::uint64_t clouds = 0;   ///< sent
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  void reply_text(std::uint64_t id, TextKind kind, std::string_view text);

  link::FaultLog& faults_;
  link::Socket socket_;
  Counts counts_;
};

}  // namespace glidar::lockstep
