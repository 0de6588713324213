// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/connection_guard.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/payload.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::link {

/// Returns freed memory to the system after peers have left. The C library keeps it otherwise:
/// pieces of a message that was cut off are freed among others that stay, so that the heap remains
/// as large as all peers together have ever made it.
class HeapTrimmer {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPause{1};

  /// A peer has left; its memory is freed soon, in other threads.
  void expect() { checks_left_ = kChecks; }
  /// Whether check() is to be called again after kPause.
  [[nodiscard]] bool is_waiting() const { return checks_left_ > 0; }
  /// Returns the memory, at most once in kPause, if it is worth the time.
  void check(Clock::time_point now);

 private:
  static constexpr int kChecks = 3;

  int checks_left_ = 0;
  Clock::time_point last_;
};

/// The topics of every connection, from the reports of ZeroMQ's XPUB socket. A connection with
/// several subscriptions is one subscriber. A second subscription to the same topic changes
/// nothing, because ZeroMQ reports only one end of both.
class SubscriptionTable {
 public:
  using Clock = std::chrono::steady_clock;

  /// For reports without a connection, i.e. those of connections that have ended.
  static constexpr ConnectionId kUnknownConnection = {};

  /// Returns the number of the connection's subscriptions. Without a connection, each subscription
  /// counts as a subscriber.
  std::size_t add(const ConnectionId& connection, const std::string& topic);
  /// Without a connection, the topic is removed from the connection with the fewest topics.
  void remove(const ConnectionId& connection, const std::string& topic);

  /// Connections that receive messages of at least one of these topics. A subscription receives all
  /// topics that begin with its own.
  [[nodiscard]] std::uint64_t subscribers(std::span<const std::string> topics) const;
  /// Subscriptions of all connections.
  [[nodiscard]] std::size_t size() const;

  /// To be called when there are no more reports. Remaining topics of a connection that ended kEnd
  /// ago were reported twice: with its number, and after the end with none or another one.
  void forget_ended(const std::function<bool(const ConnectionId&)>& is_open, Clock::time_point now);
  /// Time after which ZeroMQ has reported the end of all subscriptions of a connection.
  static constexpr std::chrono::seconds kEnd{10};

 private:
  using Topics =
      std::map<std::string, std::uint64_t>;  ///< number of subscriptions; 1 for a known connection

  struct Connection {
    Topics topics;
    std::optional<Clock::time_point> ended;
  };
  std::map<ConnectionId, Connection> connections_;
};

}  // namespace glidar::link

/// A thin layer over ZeroMQ for all protocols, which reports errors as Error.
namespace glidar::link {

/// Keys of CURVE (https://rfc.zeromq.org/spec/26), 40 characters of Z85 each.
struct CurveKeys {
  std::string public_key;
  std::string secret_key;
};
CurveKeys make_curve_keys();

/// ZeroMQ's I/O thread; must outlive its sockets. The destructor waits until all messages are sent,
/// at most for the sockets' `linger`.
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

/// The number of connections that have subscribed to a topic.
struct SubscriptionCount {
  bool is_known = false;  ///< false for sockets that keep the newest message only
  std::uint64_t subscribers = 0;
};

/// Limits of a listening socket, and the log of violations, which must outlive it.
struct Protection {
  ConnectionLimits limits;
  ErrorLog& errors;
};

/// Limits of one subscriber.
struct SubscriptionLimits {
  std::size_t subscriptions = 64;
  std::size_t topic_bytes = 64;
};

struct SocketOptions {
  SocketKind kind = SocketKind::publish;
  int send_queue = 1000;      ///< messages queued for each peer; 0: unlimited
  int receive_queue = 1000;   ///< messages queued from each peer; 0: unlimited
  bool keeps_newest = false;  ///< only the last message is queued
  /// A peer that sends a larger message is cut off before memory is allocated.
  std::int64_t max_message_bytes = std::int64_t{1} << 20;
  std::chrono::milliseconds linger{0};  ///< time for unsent messages after it is closed
  bool reports_events = false;          ///< events() returns the events of its connections
  /// For listening sockets: peers need the public key, and all messages are encrypted. Empty: no
  /// encryption, any peer.
  std::optional<CurveKeys> curve = {};
  std::optional<Protection> protection = {};  ///< empty: no limits
  SubscriptionLimits subscriptions = {};
};

/// The result of sending a message. Other peers are never affected.
enum class Sending : std::uint8_t { sent, queue_full, peer_gone };

/// One part of a message, and the owner of its bytes, which is released when they are sent.
struct Part {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
};

/// A received message; its bytes are valid until it is destroyed.
class Message {
 public:
  Message();
  Message(Message&&) noexcept;
  Message& operator=(Message&&) noexcept;
  ~Message();
  [[nodiscard]] std::span<const std::byte> bytes() const;
  /// False if it is one of several parts; the other parts are received as the next messages.
  [[nodiscard]] bool is_whole() const;
  /// False if another part follows, which has arrived too.
  [[nodiscard]] bool is_last() const;
  /// Its connection. The cookie is known for the last part if the socket has protection.
  [[nodiscard]] ConnectionId connection() const;

 private:
  friend class Socket;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Used by one thread at a time. Functions do not block unless documented.
class Socket {
 public:
  Socket(Context& context, const SocketOptions& options);
  ~Socket();
  Socket(Socket&&) noexcept;
  Socket& operator=(Socket&&) noexcept;

  /// Throws Error if the port is in use or the address is not one of this machine.
  void bind(const Endpoint& endpoint);
  /// The peer may start later and restart. Throws Error if the host name has no address.
  void connect(const Endpoint& endpoint);
  void subscribe(std::string_view topic);
  /// The endpoint at which it listens, with the actual port.
  [[nodiscard]] std::string bound_to() const;

  /// Replaces SocketOptions::linger.
  void set_linger(std::chrono::milliseconds linger);

  std::optional<Message> receive();
  /// Sends to the only peer; false: there is none or its queue is full.
  bool send(std::span<const std::byte> bytes);
  /// Sends several parts without copying them; their owners are released in another thread. A
  /// router sends to the peer whose identity is the first part.
  Sending send_parts(std::span<const Part> parts);

  /// Sends to all subscribers without a copy. False: one or more queues were full, and these
  /// subscribers miss it, if they are subscribed to its topic.
  bool publish(Payload payload);
  /// The same, blocking up to `timeout` for full queues.
  bool publish(std::span<const std::byte> bytes, std::chrono::milliseconds timeout);

  /// Number of connections that have subscribed to any of these topics; the next message reaches
  /// them.
  SubscriptionCount subscriptions(std::span<const std::string> topics);
  /// Connection events since the last call, if reports_events; to be called regularly, because
  /// events are stored until then.
  std::vector<PeerEvent> events();
  /// Closes a connection, if the socket has protection, and logs an error of this kind.
  void cut_off(const ConnectionId& connection, const std::string& kind, const std::string& why);
  /// Bytes that the peer has received; 0: unknown, or no protection.
  [[nodiscard]] std::uint64_t taken_bytes(const ConnectionId& connection) const;
  /// False if the connection has ended; true without protection.
  [[nodiscard]] bool is_open(const ConnectionId& connection) const;

 private:
  void note_subscription(const Message& message);
  [[nodiscard]] bool has_full_queue() const;

  friend bool wait_for(std::initializer_list<const Socket*>, int, std::chrono::milliseconds);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Blocks until one of the sockets has a message, the file descriptor (-1: none) is readable, the
/// time is over, or a signal arrives. True in the first two cases.
bool wait_for(std::initializer_list<const Socket*> sockets, int descriptor,
              std::chrono::milliseconds at_most);

}  // namespace glidar::link

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
