// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>
#include <glidar/link/error_log.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace glidar::link {

/// Limits of peers, for each or for all together. limit_kinds() describes each.
struct Limits {
  std::int64_t connections = 256;
  std::int64_t connections_per_s = 500;
  std::int64_t handshake_s = 5;
  std::int64_t request_mib = 16;
  std::int64_t requests = 16;
  std::int64_t request_s = 600;
  std::int64_t reply_mib = 1024;
  std::int64_t memory_mib = 2048;
  std::int64_t subscriptions = 64;
  std::int64_t topic_bytes = 64;

  bool operator==(const Limits&) const = default;
};

/// One limit: its name, range and description.
struct LimitKind {
  std::string_view name;
  std::int64_t Limits::*value;
  std::int64_t min;
  std::int64_t max;
  std::string_view meaning;
};

/// All limits, in the order of the members.
std::span<const LimitKind> limit_kinds();

/// Sets a limit by "NAME=VALUE", for example "reply-mib=4096". Throws Error for an unknown name and
/// for a value that is not an integer in its range.
void set_limit(Limits& limits, std::string_view text);

/// "at most 16 (--limit requests=16)", for errors.
std::string limit_text(const Limits& limits, std::int64_t Limits::*value);

constexpr std::int64_t bytes_of_mib(std::int64_t mib) {
  return mib << 20;
}

/// Blocks and drains a listening socket of ZeroMQ, which itself accepts every connection. Used by
/// one thread.
class Listener {
 public:
  /// For this descriptor, which ZeroMQ owns.
  explicit Listener(int descriptor);

  /// Makes the kernel discard attempts to connect, which clients repeat for a minute or more;
  /// existing connections are not affected. TCP only.
  void pause();
  void resume();
  [[nodiscard]] bool is_paused() const { return is_paused_; }
  /// Closes the connections that wait to be accepted; returns true if none is left. Works without a
  /// free descriptor.
  bool discard_waiting();

 private:
  UniqueFd descriptor_;
  UniqueFd spare_;  ///< closed temporarily if there is no free descriptor
  bool is_paused_ = false;
};

/// Raises the process's limit of open files for these connections, as far as the system allows.
void raise_descriptor_limit(std::int64_t connections);

/// Throws Error unless the process can open this many more descriptors.
void require_descriptors(int count);

/// The maximum number of descriptors of this process.
int descriptor_limit();

/// Events of a socket's connections.
enum class PeerEvent : std::uint8_t { joined, left, refused };

/// Identifies a connection: descriptors are reused, the kernel's cookies are not.
struct ConnectionId {
  int descriptor = -1;       ///< -1: unknown
  std::uint64_t cookie = 0;  ///< 0: unknown

  bool operator==(const ConnectionId&) const = default;
  bool operator<(const ConnectionId& other) const {
    return std::tie(descriptor, cookie) < std::tie(other.descriptor, other.cookie);
  }
};

/// Limits of the connections to one listening socket.
struct ConnectionLimits {
  std::size_t connections = 256;
  double connections_per_s = 100.0;
  std::chrono::seconds handshake{5};
  std::uint64_t unread_bytes = std::uint64_t{64}
                               << 10;  ///< of one connection: received but not delivered
  std::uint64_t all_unread_bytes = std::uint64_t{1} << 20;  ///< of all connections
  /// Allowance of one connection for handshakes and heartbeats, which are bytes without a message.
  double free_bytes_per_s = 32.0;
  bool counts_delivered = false;  ///< delivered bytes count too, for peers that send little
};

/// Limits of a port whose peers send at most these bytes before they are delivered, one peer or
/// all.
ConnectionLimits connection_limits(const Limits& limits, std::uint64_t unread_bytes,
                                   std::uint64_t all_unread_bytes);

/// Monitors the connections of a listening socket and closes those that exceed the limits. ZeroMQ
/// itself accepts any number of connections, and collects all parts of a message in memory before
/// it delivers the first one. This class counts by means of ZeroMQ's monitor and the kernel's
/// counters, and closes connections from outside, together with data that ZeroMQ has not read;
/// ZeroMQ then frees its memory.
/// Functions may be called from any thread. Those that begin with "on" are called for events of the
/// monitor.
class ConnectionGuard {
 public:
  using Clock = std::chrono::steady_clock;

  /// The log must outlive it.
  ConnectionGuard(const ConnectionLimits& limits, ErrorLog& errors, bool keeps_events = true);

  void on_listening(int descriptor);
  void on_accepted(int descriptor);
  void on_accept_failed(int error);
  void on_joined();
  void on_left(int descriptor);
  void on_refused();

  /// To be called every kCheckInterval while needs_check(): finds connections that exceed limits
  /// or have ended.
  void check_limits();
  [[nodiscard]] bool needs_check() const;
  static constexpr std::chrono::milliseconds kCheckInterval{20};

  /// To be called when a whole message of the connection is delivered: its bytes so far are read.
  /// Returns the cookie.
  std::uint64_t delivered(int descriptor);
  /// Closes the connection and logs an error of this kind.
  void cut_off(const ConnectionId& connection, const std::string& kind, const std::string& why);
  /// False if the connection has ended.
  [[nodiscard]] bool is_open(const ConnectionId& connection) const;
  /// Bytes that the peer has received; 0: unknown.
  [[nodiscard]] std::uint64_t taken_bytes(const ConnectionId& connection) const;
  /// Events since the last call, in order, if events are kept.
  std::vector<PeerEvent> events();

 private:
  struct Connection {
    std::uint64_t cookie = 0;  ///< of the kernel, unique
    Clock::time_point since;
    std::uint64_t read_bytes = 0;  ///< received by the kernel at the last delivery
    bool has_delivered = false;
    bool is_cut = false;
  };
  using Connections = std::map<int, Connection>;

  /// The entry of an open connection, which is added if necessary.
  Connection& find_or_add(int descriptor);
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
  void cut(Connections::iterator connection, const std::string& kind, const std::string& why);
  [[nodiscard]] std::size_t open_connections() const;

  mutable std::mutex mutex_;
  ConnectionLimits limits_;
  ErrorLog& errors_;
  bool keeps_events_;
  Connections connections_;
  std::optional<Listener> listener_;
  std::vector<PeerEvent> events_;
  double allowance_;  ///< connections that may be accepted now
  Clock::time_point refilled_;
  bool is_refused_ = false;  ///< the next connection that ends was refused
  bool lacks_descriptors_ = false;
};

}  // namespace glidar::link
