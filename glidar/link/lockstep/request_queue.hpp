// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/limits.hpp>
#include <glidar/link/router.hpp>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace glidar::lockstep {

using Clock = std::chrono::steady_clock;

/// Replies that were sent but not read. Those on their way hold it too.
struct Unread {
  std::atomic<std::int64_t> replies{0};
  std::atomic<std::int64_t> bytes{0};
};

/// A request that waits for its turn.
struct Waiting {
  link::Delivered message;
  Clock::time_point since;
};

/// Requests of all clients that wait, and what each client has under way. Clients take turns, one
/// request each, however many each of them sends.
class RequestQueue {
 public:
  explicit RequestQueue(const link::Limits& limits) : limits_(limits) {}

  /// Why the request cannot be taken, with the limit; empty: it is taken (moved from).
  std::string add(link::Delivered& message, Clock::time_point now);
  /// The next one in turn; nothing: none waits whose client has no other one in work. It is in work
  /// until done() is called.
  std::optional<Waiting> next();
  /// The request of this client that is in work was answered.
  void done(const std::string& client);

  /// What this client has not read; to be counted up with each reply.
  std::shared_ptr<Unread> unread_of(const link::ReturnAddress& client);
  /// Of all clients together.
  [[nodiscard]] const std::shared_ptr<Unread>& all_unread() const { return all_unread_; }
  [[nodiscard]] std::int64_t waiting_bytes() const { return waiting_bytes_; }

  /// Forgets clients that have nothing under way, and calls `stalled` with the connection of each
  /// that has read nothing of its replies for so long. `progress` returns a number that changes
  /// when a connection takes bytes.
  void look(Clock::time_point now, std::chrono::seconds patience,
            const std::function<std::uint64_t(const link::ConnectionId&)>& progress,
            const std::function<void(const link::ConnectionId&)>& stalled);
  [[nodiscard]] bool has_clients() const { return !clients_.empty(); }

 private:
  struct Client {
    std::deque<Waiting> waiting;
    bool is_served = false;  ///< one of its requests is in work
    std::shared_ptr<Unread> unread = std::make_shared<Unread>();
    link::ConnectionId connection;
    std::uint64_t progress = 0;
    Clock::time_point progress_time;
  };

  link::Limits limits_;
  std::map<std::string, Client> clients_;  ///< that have something under way
  std::deque<std::string> turns_;          ///< clients that wait and have nothing in work
  std::int64_t waiting_bytes_ = 0;
  std::shared_ptr<Unread> all_unread_ = std::make_shared<Unread>();
};

}  // namespace glidar::lockstep
