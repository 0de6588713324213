// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/connection_guard.hpp>
#include <glidar/link/curve.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/payload.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A thin layer over ZeroMQ that all protocols share: what they need of it, with errors as Error.
namespace glidar::link {

/// ZeroMQ's thread for input and output; must outlive its sockets. Destroying it waits until what
/// was sent is gone, at most the sockets' `linger`.
class Context {
 public:
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

 private:
  friend class Socket;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

enum class SocketKind : std::uint8_t {
  publish,
  subscribe,
  request,
  reply,
  router  ///< answers many requests at once; see Router
};

/// What ZeroMQ reports of subscribers: how many connections have subscribed to a topic.
struct SubscriptionCount {
  bool is_known = false;  ///< not of sockets that keep the newest message only
  std::uint64_t subscribers = 0;
};

/// Limits of a socket that listens, and who is told of what exceeds them; must outlive it.
struct Protection {
  ConnectionLimits limits;
  FaultLog& faults;
};

/// What one subscriber may subscribe to.
struct SubscriptionLimits {
  std::size_t subscriptions = 64;
  std::size_t topic_bytes = 64;
};

struct SocketOptions {
  SocketKind kind = SocketKind::publish;
  int send_queue = 1000;      ///< messages that wait for each peer; 0: any number
  int receive_queue = 1000;   ///< likewise
  bool keeps_newest = false;  ///< only the last message waits, whatever the queues
  /// A peer that sends more is cut off before the memory is taken.
  std::int64_t largest_message_bytes = std::int64_t{1} << 20;
  std::chrono::milliseconds linger{0};  ///< for what is unsent when it is closed
  bool is_watched = false;              ///< events() tells of its connections
  /// Of who listens: peers must know the public key, and all is encrypted. Empty: anybody may.
  std::optional<CurveKeys> curve = {};
  std::optional<Protection> protection = {};  ///< empty: any number of connections
  SubscriptionLimits subscriptions = {};
};

/// What became of a message. No other peer is affected in any case.
enum class Sending : std::uint8_t { sent, queue_full, peer_gone };

/// One part of a message, and who keeps its bytes until they are sent.
struct Part {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
};

/// Bytes of a message that was received; valid until it is destroyed.
class Message {
 public:
  Message();
  Message(Message&&) noexcept;
  Message& operator=(Message&&) noexcept;
  ~Message();
  [[nodiscard]] std::span<const std::byte> bytes() const;
  /// False when it was only one of several parts; the parts after it come as the next ones.
  [[nodiscard]] bool is_whole() const;
  /// False when another part follows, which is here too.
  [[nodiscard]] bool is_last() const;
  /// That it came by. The cookie is known of the last part, where the socket has protection.
  [[nodiscard]] ConnectionId connection() const;

 private:
  friend class Socket;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Used by one thread at a time. No function waits unless it says so.
class Socket {
 public:
  Socket(Context& context, const SocketOptions& options);
  ~Socket();
  Socket(Socket&&) noexcept;
  Socket& operator=(Socket&&) noexcept;

  /// Throws Error when the port is in use or the address is not this machine's.
  void bind(const Endpoint& endpoint);
  /// The peer may come later and come back. Throws Error when the host makes no address.
  void connect(const Endpoint& endpoint);
  void subscribe(std::string_view topic);
  /// Where it listens, with the port that was free.
  [[nodiscard]] std::string bound_to() const;

  /// Replaces the option, for what is unsent when it is closed.
  void set_linger(std::chrono::milliseconds linger);

  std::optional<Message> receive();
  /// To the one peer; false: there is none or its queue is full.
  bool send(std::span<const std::byte> bytes);
  /// The same of several parts, none of which is copied; their owners are released in another
  /// thread. A router sends to the peer whose identity is the first part.
  Sending send_parts(std::span<const Part> parts);

  /// To all subscribers, without a copy. False: the queue of one or more was full, and these miss
  /// it, if they want its topic.
  bool publish(Payload payload);
  /// The same, waiting so long for full queues.
  bool publish(std::span<const std::byte> bytes, std::chrono::milliseconds patience);

  /// How many connections have subscribed to any of these topics. The next message reaches them.
  SubscriptionCount subscriptions(std::span<const std::string> topics);
  /// What happened since the last call, if it is watched; to be called now and then, as what is not
  /// taken is kept.
  std::vector<PeerEvent> events();
  /// Closes a connection, if the socket has protection, and reports it as a fault of this kind.
  void cut_off(const ConnectionId& connection, const std::string& fault, const std::string& why);
  /// What the peer has received of what was sent to it; 0: not known, or without protection.
  [[nodiscard]] std::uint64_t taken_bytes(const ConnectionId& connection) const;
  /// False: it has ended; true without protection.
  [[nodiscard]] bool is_open(const ConnectionId& connection) const;

 private:
  void note_subscription(const Message& message);
  [[nodiscard]] bool has_full_queue() const;

  friend void wait_for(std::initializer_list<const Socket*>, int, std::chrono::milliseconds);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Waits until one of the sockets has something to receive, the file descriptor (-1: none) can be
/// read, or the time is over; signals end it too.
void wait_for(std::initializer_list<const Socket*> sockets, int descriptor,
              std::chrono::milliseconds at_most);

}  // namespace glidar::link
