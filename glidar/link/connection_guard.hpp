// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/fault_log.hpp>
#include <glidar/link/limits.hpp>
#include <glidar/link/listener.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace glidar::link {

/// What happened to a socket's connections.
enum class PeerEvent : std::uint8_t { joined, left, refused };

/// A connection: a descriptor may be used again for another one, the cookie of the kernel is not.
struct ConnectionId {
  int descriptor = -1;       ///< -1: not known
  std::uint64_t cookie = 0;  ///< 0: not known

  bool operator==(const ConnectionId&) const = default;
  bool operator<(const ConnectionId& other) const {
    return std::tie(descriptor, cookie) < std::tie(other.descriptor, other.cookie);
  }
};

/// What connections to one listening socket may use.
struct ConnectionLimits {
  std::size_t connections = 256;
  double connections_per_s = 100.0;
  std::chrono::seconds handshake{5};
  std::uint64_t unread_bytes = std::uint64_t{64} << 10;     ///< of one: received, not yet delivered
  std::uint64_t all_unread_bytes = std::uint64_t{1} << 20;  ///< of all
  /// Of one, free at any time: handshakes and heartbeats are bytes without a message.
  double free_bytes_per_s = 32.0;
  bool counts_delivered = false;  ///< what was delivered counts as well: peers have little to say
};

/// Of a port whose peers send at most so much before it is delivered, one or all of them.
ConnectionLimits connection_limits(const Limits& limits, std::uint64_t unread_bytes,
                                   std::uint64_t all_unread_bytes);

/// Watches the connections of a listening socket and closes those that exceed the limits. ZeroMQ
/// itself accepts any number, and gathers any number of parts of a message in memory before it
/// delivers the first one. This class counts, from the reports of ZeroMQ's monitor and the kernel's
/// counters, and ends connections from outside, together with what ZeroMQ has not yet read of them;
/// ZeroMQ then frees what it holds.
/// Functions may be called from any thread; those that begin with "on" report what the monitor
/// reported.
class ConnectionGuard {
 public:
  using Clock = std::chrono::steady_clock;

  /// The log must outlive it.
  ConnectionGuard(const ConnectionLimits& limits, FaultLog& faults, bool keeps_events = true);

  void on_listening(int descriptor);
  void on_accepted(int descriptor);
  void on_accept_failed(int error);
  void on_joined();
  void on_left(int descriptor);
  void on_refused();

  /// To be called every kLook while needs_look(): finds connections that exceed limits, and those
  /// that ended.
  void look();
  [[nodiscard]] bool needs_look() const;
  static constexpr std::chrono::milliseconds kLook{20};

  /// A whole message of the connection was delivered: what it has sent so far is read. Returns its
  /// cookie.
  std::uint64_t delivered(int descriptor);
  /// Closes the connection, and reports it as a fault of this kind.
  void cut_off(const ConnectionId& connection, const std::string& fault, const std::string& why);
  /// False: it has ended.
  [[nodiscard]] bool is_open(const ConnectionId& connection) const;
  /// What the other side has received of what was sent to it; 0: not known.
  [[nodiscard]] std::uint64_t taken_bytes(const ConnectionId& connection) const;
  /// What happened since the last call, in order, if events are kept.
  std::vector<PeerEvent> events();

 private:
  struct Connection {
    std::uint64_t cookie = 0;  ///< of the kernel, never used again for another one
    Clock::time_point since;
    std::uint64_t read_bytes = 0;  ///< that the kernel had received at the last delivery
    bool has_delivered = false;
    bool is_cut = false;
  };
  using Connections = std::map<int, Connection>;

  /// The entry of an open connection; a new one unless it is known.
  Connection& take_note(int descriptor);
  void note(PeerEvent event);
  [[nodiscard]] double burst() const;
  void refill(Clock::time_point now);
  [[nodiscard]] bool is_full() const;
  [[nodiscard]] bool is_held_back() const;
  void make_room();
  void hold_back_for_lack();
  void free_descriptors();
  void hold_back();
  void report_descriptors();
  void check_unread();
  void cut(Connections::iterator connection, const std::string& fault, const std::string& why);
  [[nodiscard]] std::size_t open_connections() const;

  mutable std::mutex mutex_;
  ConnectionLimits limits_;
  FaultLog& faults_;
  bool keeps_events_;
  Connections connections_;
  std::optional<Listener> listener_;
  std::vector<PeerEvent> events_;
  double allowance_;  ///< connections that may come now
  Clock::time_point refilled_;
  bool is_refused_ = false;  ///< the connection that leaves next
  bool lacks_descriptors_ = false;
};

}  // namespace glidar::link
