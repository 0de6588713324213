// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/limits.hpp>
#include <glidar/link/router.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace glidar::lockstep {

using Clock = std::chrono::steady_clock;

/// Counts replies that are sent but not read; replies in transit share it.
struct Unread {
  std::atomic<std::int64_t> replies{0};
  std::atomic<std::int64_t> bytes{0};
};

/// A queued request.
struct Waiting {
  link::Delivered message;
  Clock::time_point since;
};

/// The queued requests of all clients, and the replies that each client has not read. Clients are
/// served in turn, one request each, however many each of them sends.
class RequestQueue {
 public:
  explicit RequestQueue(const link::Limits& limits) : limits_(limits) {}

  /// Returns the error, with the limit, if the request is not accepted; empty: it is (moved from).
  std::string add(link::Delivered& message, Clock::time_point now);
  /// The next request in turn; empty if no client without a request in progress has one. It is in
  /// progress until done() is called.
  std::optional<Waiting> next();
  /// To be called when the request in progress of this client is answered.
  void done(const std::string& client);

  /// The counter of this client's unread replies, to be increased with each reply.
  std::shared_ptr<Unread> unread_of(const link::ReturnAddress& client);
  /// Bytes of all clients together.
  [[nodiscard]] const std::shared_ptr<Unread>& all_unread() const { return all_unread_; }
  [[nodiscard]] std::int64_t waiting_bytes() const { return waiting_bytes_; }

  /// Removes clients without requests and replies, and calls `stalled` with the connection of each
  /// client that has read nothing of its replies for `timeout`. `progress` returns a number that
  /// changes when a connection receives bytes.
  void check_clients(Clock::time_point now, std::chrono::seconds timeout,
                     const std::function<std::uint64_t(const link::ConnectionId&)>& progress,
                     const std::function<void(const link::ConnectionId&)>& stalled);
  [[nodiscard]] bool has_clients() const { return !clients_.empty(); }

 private:
  struct Client {
    std::deque<Waiting> waiting;
    bool is_served = false;  ///< one of its requests is in progress
    std::shared_ptr<Unread> unread = std::make_shared<Unread>();
    link::ConnectionId connection;
    std::uint64_t progress = 0;
    Clock::time_point progress_time;
  };

  link::Limits limits_;
  std::map<std::string, Client> clients_;  ///< with requests or unread replies
  std::deque<std::string> ready_clients_;  ///< clients with queued requests and none in progress
  std::int64_t waiting_bytes_ = 0;
  std::shared_ptr<Unread> all_unread_ = std::make_shared<Unread>();
};

}  // namespace glidar::lockstep
