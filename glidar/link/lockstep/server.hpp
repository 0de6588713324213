// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/fault_log.hpp>
#include <glidar/link/lockstep/messages.hpp>
#include <glidar/link/lockstep/request_queue.hpp>
#include <glidar/link/router.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::lockstep {

struct ServerOptions {
  link::Endpoint endpoint = {.host = "127.0.0.1"};
  std::optional<link::CurveKeys> curve = {};  ///< empty: not encrypted
  link::Limits limits = {};
};

/// A measured cloud on its way to the client.
struct CloudReply {
  CloudHead head;
  std::shared_ptr<const PointCloud> cloud;  ///< kept until it is sent
};

/// What a reply belongs to.
struct ReplyTo {
  link::ReturnAddress from;
  std::uint64_t id = 0;
  Clock::time_point since;          ///< the request waits
  std::int64_t reserved_bytes = 0;  ///< for the reply
};

struct Received {
  Request request;
  ReplyTo to;
};

/// Receives requests from any number of clients, in turn, and replies in any order. Every request
/// that is received is to be replied to or dropped, once; a client gets its next turn after that.
/// Used by one thread.
class Server {
 public:
  /// Listens. Throws Error. The context and the log must outlive it.
  Server(link::Context& context, const ServerOptions& options, link::FaultLog& faults);

  /// The next request; nothing: there is none now. Never waits. A message that is no request, or
  /// exceeds a limit, is replied to with an error. To be called often: it also takes care of
  /// clients that do not read.
  std::optional<Received> receive();
  /// Reserves memory for a reply of so many bytes, once for each request. False: there is none
  /// until other clients have read theirs; under this pressure, those that read nothing for a
  /// second are cut off.
  bool reserve(ReplyTo& to, std::int64_t bytes);

  /// False: the client has left, so that its request is to be dropped.
  [[nodiscard]] bool is_wanted(const ReplyTo& to) const;
  /// Instead of a reply.
  void drop(const ReplyTo& to);

  void reply(const ReplyTo& to, std::span<const CloudReply> clouds);
  void reply_error(const ReplyTo& to, std::string_view text);
  void reply_description(const ReplyTo& to, std::string_view json);

  [[nodiscard]] const link::Socket& socket() const { return router_.socket(); }
  /// How long to wait for the socket at most before receive() is called again.
  [[nodiscard]] std::chrono::milliseconds patience() const;

  struct Counts {
    std::uint64_t received = 0;
    std::uint64_t refused = 0;  ///< of these, with an error
    std::uint64_t clouds = 0;   ///< sent
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  void collect();
  void refuse(const link::Delivered& message, std::string_view why);
  std::optional<Request> read(const Waiting& waiting, ReplyTo& to);
  void look_after_clients(std::chrono::seconds patience);
  void reply_text(const ReplyTo& to, TextKind kind, std::string_view text);
  void send(const ReplyTo& to, std::vector<link::Part> parts);

  link::Limits limits_;
  link::FaultLog& faults_;
  link::Router router_;
  RequestQueue queue_;
  std::int64_t reserved_bytes_ = 0;
  Clock::time_point looked_;
  Counts counts_;
};

}  // namespace glidar::lockstep
