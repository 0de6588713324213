// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/ipc_place.hpp>
#include <glidar/link/subscription_table.hpp>

#include <zmq.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace glidar::link {
namespace {

/// XPUB speaks as PUB does and tells of subscriptions besides, but cannot keep the newest only.
zmq::socket_type type_of(const SocketOptions& options) {
  switch (options.kind) {
    case SocketKind::subscribe:
      return zmq::socket_type::sub;
    case SocketKind::request:
      return zmq::socket_type::req;
    case SocketKind::reply:
      return zmq::socket_type::rep;
    case SocketKind::publish:
      break;
  }
  return options.keeps_newest ? zmq::socket_type::pub : zmq::socket_type::xpub;
}

[[noreturn]] void fail(const Endpoint& endpoint, const zmq::error_t& error, const char* doing) {
  std::string remedy;
  if (error.num() == EADDRINUSE) {
    remedy = "another program has this port: end it, or choose another port";
  } else if (error.num() == EADDRNOTAVAIL || error.num() == ENODEV) {
    remedy = "give an address of this machine, such as 127.0.0.1, or * for all";
  } else if (error.num() == EINVAL) {
    remedy = "give an IPv4 address or a host's name";
  } else if (error.num() == EACCES) {
    remedy = "choose a port from 1024 on";
  }
  throw Error({.where = text_of(endpoint),
               .found = std::string("cannot ") + doing + ": " + error.what(),
               .allowed = "",
               .remedy = remedy});
}

std::chrono::milliseconds::rep millis(std::chrono::milliseconds time) {
  return time.count();
}

/// A payload that ZeroMQ has, and the count of these.
struct Flying {
  Payload payload;
  std::shared_ptr<std::atomic<int>> count;
};

/// Gives a payload back to its pool once ZeroMQ has no more use for it, in ZeroMQ's own thread.
void release(void* /*bytes*/, void* flying) {
  --*static_cast<Flying*>(flying)->count;
  delete static_cast<Flying*>(flying);
}

/// Lets go of who keeps the bytes of a part.
void let_go(void* /*bytes*/, void* owner) {
  delete static_cast<std::shared_ptr<const void>*>(owner);
}

/// Subscriptions to longer ones are no concern of anybody here.
constexpr std::size_t kLongestTopic = 64;

/// The result of an action that a signal may break off; it is then done again.
template <class Action>
auto unbroken(const Action& action) {
  for (;;) {
    try {
      return action();
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR) throw;
    }
  }
}

/// The descriptor of the connection that a message came by. The end of a subscription has none when
/// the connection ended first.
int connection_of(zmq::message_t& message) {
  const int descriptor = zmq_msg_get(message.handle(), ZMQ_SRCFD);
  return descriptor < 0 ? SubscriptionTable::kUnknownConnection : descriptor;
}

/// A socket does what is due only when it is used; this uses it.
void notice_news(zmq::socket_t& socket) {
  (void)unbroken([&socket] { return socket.get(zmq::sockopt::events); });
}

}  // namespace

struct Context::Impl {
  zmq::context_t context{1};
  std::atomic<std::uint64_t> sockets{0};  ///< made so far
};

Context::Context() : impl_(std::make_unique<Impl>()) {}
Context::~Context() = default;

std::string text_of(const Endpoint& endpoint) {
  if (!endpoint.path.empty()) return "ipc://" + endpoint.path;
  return "tcp://" + endpoint.host + ":" +
         (endpoint.port == 0 ? "*" : std::to_string(endpoint.port));
}

Endpoint parse_endpoint(const std::string& text) {
  constexpr std::string_view kTcp = "tcp://";
  constexpr std::string_view kIpc = "ipc://";
  const auto refuse = [&](const char* remedy) {
    throw Error({.where = "endpoint",
                 .found = "'" + text + "'",
                 .allowed = "tcp://HOST:PORT with a port up to 65535, or ipc://PATH",
                 .remedy = remedy});
  };
  if (text.starts_with(kIpc)) {
    constexpr std::size_t kLongest = 107;  // sun_path of unix(7)
    const std::string path = text.substr(kIpc.size());
    if (path.empty() || path.size() > kLongest) refuse("give a path of 1 to 107 letters");
    return {.host = {}, .port = 0, .path = path};
  }
  const std::size_t colon = text.rfind(':');
  if (!text.starts_with(kTcp) || colon <= kTcp.size()) refuse("for example tcp://127.0.0.1:5600");
  Endpoint endpoint{.host = text.substr(kTcp.size(), colon - kTcp.size())};
  const std::string_view port = std::string_view(text).substr(colon + 1);
  if (port == "*") return endpoint;
  const auto [stop, fault] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (fault != std::errc() || stop != port.data() + port.size() || endpoint.port == 0) {
    refuse("a port is a number from 1 to 65535, or * for any");
  }
  return endpoint;
}

CurveKeys make_curve_keys() {
  constexpr std::size_t kLetters = 40;
  std::array<char, kLetters + 1> public_key{};
  std::array<char, kLetters + 1> secret_key{};
  if (zmq_curve_keypair(public_key.data(), secret_key.data()) != 0) throw zmq::error_t();
  return {public_key.data(), secret_key.data()};
}

struct Message::Impl {
  zmq::message_t message;
  bool is_part = false;
  bool is_last = true;
};

Message::Message() : impl_(std::make_unique<Impl>()) {}
Message::Message(Message&&) noexcept = default;
Message& Message::operator=(Message&&) noexcept = default;
Message::~Message() = default;

std::span<const std::byte> Message::bytes() const {
  return {static_cast<const std::byte*>(impl_->message.data()), impl_->message.size()};
}

bool Message::is_whole() const {
  return !impl_->is_part;
}

bool Message::is_last() const {
  return impl_->is_last;
}

struct Socket::Impl {
  zmq::socket_t socket;
  zmq::socket_t monitor;  ///< tells of connections
  bool follows_part = false;
  SubscriptionTable subscriptions;
  int send_queue;
  std::shared_ptr<std::atomic<int>> flying = std::make_shared<std::atomic<int>>(0);
  bool is_behind = false;  ///< a subscriber's queue was full

  Impl(zmq::context_t& context, const SocketOptions& options)
      : socket(context, type_of(options)),
        monitor(context, zmq::socket_type::pair),
        send_queue(options.send_queue) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  /// The monitor ends first: it is told by the socket.
  ~Impl() { zmq_socket_monitor(socket.handle(), nullptr, 0); }

  void watch(std::uint64_t number) {
    constexpr int kEvents = ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_DISCONNECTED |
                            ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                            ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL;
    const std::string name = "inproc://monitor-" + std::to_string(number);
    if (zmq_socket_monitor(socket.handle(), name.c_str(), kEvents) != 0) throw zmq::error_t();
    monitor.set(zmq::sockopt::linger, 0);
    monitor.set(zmq::sockopt::rcvhwm, 0);  // a full queue would hold up ZeroMQ's thread
    monitor.connect(name);
  }
};

Socket::Socket(Context& context, const SocketOptions& options)
    : impl_(std::make_unique<Impl>(context.impl_->context, options)) {
  zmq::socket_t& socket = impl_->socket;
  socket.set(zmq::sockopt::linger, static_cast<int>(millis(options.linger)));
  socket.set(zmq::sockopt::sndhwm, options.send_queue);
  socket.set(zmq::sockopt::rcvhwm, options.receive_queue);
  socket.set(zmq::sockopt::maxmsgsize, options.largest_message_bytes);
  if (options.keeps_newest) socket.set(zmq::sockopt::conflate, true);
  if (options.curve) {
    socket.set(zmq::sockopt::curve_server, 1);
    socket.set(zmq::sockopt::curve_secretkey, options.curve->secret_key);
  }
  if (type_of(options) == zmq::socket_type::xpub) socket.set(zmq::sockopt::xpub_verboser, 1);
  if (options.is_watched) impl_->watch(context.impl_->sockets++);
}

Socket::~Socket() = default;
Socket::Socket(Socket&&) noexcept = default;
Socket& Socket::operator=(Socket&&) noexcept = default;

void Socket::bind(const Endpoint& endpoint) {
  if (!endpoint.path.empty()) require_free_place(endpoint.path);
  try {
    impl_->socket.bind(text_of(endpoint));
  } catch (const zmq::error_t& error) {
    fail(endpoint, error, "listen there");
  }
}

void Socket::connect(const Endpoint& endpoint) {
  try {
    impl_->socket.connect(text_of(endpoint));
  } catch (const zmq::error_t& error) {
    fail(endpoint, error, "connect to it");
  }
}

void Socket::subscribe(std::string_view topic) {
  impl_->socket.set(zmq::sockopt::subscribe, std::string(topic));
}

std::optional<Message> Socket::receive() {
  zmq::message_t received;
  const auto take = [&] { return impl_->socket.recv(received, zmq::recv_flags::dontwait); };
  if (!unbroken(take)) return std::nullopt;
  Message message;
  const bool follows = std::exchange(impl_->follows_part, received.more());
  message.impl_->is_part = follows || received.more();
  message.impl_->is_last = !received.more();
  message.impl_->message = std::move(received);
  return message;
}

bool Socket::send(std::span<const std::byte> bytes) {
  zmq::message_t message(bytes.data(), bytes.size());
  const auto give = [&] { return impl_->socket.send(message, zmq::send_flags::dontwait); };
  return unbroken(give).has_value();
}

bool Socket::send_parts(std::span<const Part> parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto owner = std::make_unique<std::shared_ptr<const void>>(parts[i].owner);
    // ZeroMQ only reads what is sent
    auto* bytes = const_cast<std::byte*>(parts[i].bytes.data());
    zmq::message_t message(bytes, parts[i].bytes.size(), let_go, owner.get());
    owner.release();  // NOLINT(bugprone-unused-return-value): the message has it
    const auto flags = i + 1 < parts.size() ? zmq::send_flags::sndmore | zmq::send_flags::dontwait
                                            : zmq::send_flags::dontwait;
    if (!unbroken([&] { return impl_->socket.send(message, flags); })) return false;
  }
  return true;
}

std::string Socket::bound_to() const {
  return impl_->socket.get(zmq::sockopt::last_endpoint);
}

namespace {

/// First only if all queues have room, so that a full one is noticed; then to those that have.
bool publish_now(zmq::socket_t& socket, zmq::message_t& message, zmq::send_flags flags) {
  notice_news(socket);  // such as that a queue has room again
  socket.set(zmq::sockopt::xpub_nodrop, true);
  if (unbroken([&] { return socket.send(message, flags); })) return true;
  socket.set(zmq::sockopt::xpub_nodrop, false);
  (void)unbroken([&] { return socket.send(message, zmq::send_flags::dontwait); });
  return false;
}

}  // namespace

/// ZeroMQ tells of a full queue once and then leaves it out until half of it was read. What is
/// half on its way counts too, so that this may be late to see it, but not early.
bool Socket::has_full_queue() const {
  impl_->is_behind = impl_->is_behind && *impl_->flying > impl_->send_queue / 2;
  return impl_->is_behind;
}

bool Socket::publish(Payload payload) {
  const bool was_full = has_full_queue();
  auto owned = std::make_unique<Flying>(Flying{std::move(payload), impl_->flying});
  const std::span<std::byte> bytes = owned->payload.bytes();
  zmq::message_t message(bytes.data(), bytes.size(), release, owned.get());
  owned.release();  // NOLINT(bugprone-unused-return-value): the message has it
  ++*impl_->flying;
  if (publish_now(impl_->socket, message, zmq::send_flags::dontwait)) return !was_full;
  impl_->is_behind = true;
  return false;
}

bool Socket::publish(std::span<const std::byte> bytes, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kLook{5};
  const auto until = std::chrono::steady_clock::now() + patience;
  while (has_full_queue() && std::chrono::steady_clock::now() < until) wait_for({}, -1, kLook);
  if (std::exchange(impl_->is_behind, false)) patience = kLook;  // in vain, which is enough once
  zmq::message_t message(bytes.data(), bytes.size());
  impl_->socket.set(zmq::sockopt::sndtimeo, static_cast<int>(millis(patience)));
  return publish_now(impl_->socket, message, zmq::send_flags::none);
}

SubscriptionCount Socket::subscriptions(std::span<const std::string> topics) {
  if (impl_->socket.get(zmq::sockopt::type) != ZMQ_XPUB) return {};
  while (std::optional<Message> message = receive()) {
    // a byte, 1 for a subscription and 0 for its end, and the topic
    const std::span<const std::byte> bytes = message->bytes();
    if (bytes.empty() || bytes.size() > kLongestTopic || std::to_integer<int>(bytes[0]) > 1) {
      continue;
    }
    const std::string topic(reinterpret_cast<const char*>(bytes.data()) + 1, bytes.size() - 1);
    const int connection = connection_of(message->impl_->message);
    if (bytes[0] == std::byte{1}) {
      impl_->subscriptions.add(connection, topic);
    } else {
      impl_->subscriptions.remove(connection, topic);
    }
  }
  return {.is_known = true, .subscribers = impl_->subscriptions.subscribers(topics)};
}

std::vector<PeerEvent> Socket::events() {
  std::vector<PeerEvent> found;
  zmq::message_t head;
  zmq::message_t address;
  while (impl_->monitor.recv(head, zmq::recv_flags::dontwait)) {
    if (head.more()) (void)impl_->monitor.recv(address, zmq::recv_flags::none);
    std::uint16_t event = 0;
    if (head.size() < sizeof(event)) continue;
    std::memcpy(&event, head.data(), sizeof(event));
    if (event == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) {
      found.push_back(PeerEvent::joined);
    } else if (event == ZMQ_EVENT_DISCONNECTED) {
      found.push_back(PeerEvent::left);
    } else {
      found.push_back(PeerEvent::refused);
    }
  }
  notice_news(impl_->socket);  // who joined again is subscribed to anew before it is told
  return found;
}

void wait_for(std::initializer_list<const Socket*> sockets, int descriptor,
              std::chrono::milliseconds at_most) {
  std::vector<zmq::pollitem_t> items;
  for (const Socket* socket : sockets) {
    if (socket != nullptr) items.push_back({socket->impl_->socket.handle(), 0, ZMQ_POLLIN, 0});
  }
  if (descriptor >= 0) items.push_back({nullptr, descriptor, ZMQ_POLLIN, 0});
  try {
    zmq::poll(items, at_most);
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
  }
}

}  // namespace glidar::link
