// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/link/connection_guard.hpp>

#include <malloc.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <zmq.h>
#include <zmq.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace glidar::link {
namespace {

/// Less than this is used again soon.
constexpr std::size_t kWorthwhile_bytes = std::size_t{8} << 20U;

}  // namespace

void HeapTrimmer::check(Clock::time_point now) {
  if (checks_left_ == 0 || now - last_ < kPause) return;
  last_ = now;
  --checks_left_;
#ifdef __GLIBC__
  if (::mallinfo2().fordblks >= kWorthwhile_bytes) ::malloc_trim(0);
#endif
}

namespace {

bool begins_any(const std::string& begin, std::span<const std::string> topics) {
  return std::any_of(topics.begin(), topics.end(),
                     [&begin](const std::string& topic) { return topic.starts_with(begin); });
}

}  // namespace

std::size_t SubscriptionTable::add(const ConnectionId& connection, const std::string& topic) {
  Topics& topics = connections_[connection].topics;
  std::uint64_t& subscriptions = topics[topic];
  if (connection == kUnknownConnection || subscriptions == 0) ++subscriptions;
  return topics.size();
}

void SubscriptionTable::remove(const ConnectionId& connection, const std::string& topic) {
  auto found = connections_.find(connection);
  if (connection == kUnknownConnection &&
      (found == connections_.end() || found->second.topics.count(topic) == 0)) {
    const auto rank = [&topic](const auto& entry) {
      const Topics& topics = entry.second.topics;
      return topics.count(topic) == 0 ? topics.size() + 2 : topics.size();
    };
    found = std::min_element(connections_.begin(), connections_.end(),
                             [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  }
  if (found == connections_.end() || found->second.topics.count(topic) == 0) return;
  Topics& topics = found->second.topics;
  if (--topics[topic] == 0) topics.erase(topic);
  if (topics.empty()) connections_.erase(found);
}

std::uint64_t SubscriptionTable::subscribers(std::span<const std::string> topics) const {
  std::uint64_t count = 0;
  for (const auto& [connection, one] : connections_) {
    std::uint64_t wanted = 0;
    for (const auto& [topic, subscriptions] : one.topics) {
      if (begins_any(topic, topics)) wanted += subscriptions;
    }
    count += connection == kUnknownConnection ? wanted : std::min<std::uint64_t>(wanted, 1);
  }
  return count;
}

std::size_t SubscriptionTable::size() const {
  std::size_t count = 0;
  for (const auto& [connection, one] : connections_) count += one.topics.size();
  return count;
}

void SubscriptionTable::forget_ended(const std::function<bool(const ConnectionId&)>& is_open,
                                     Clock::time_point now) {
  for (auto one = connections_.begin(); one != connections_.end();) {
    const bool is_known = one->first != kUnknownConnection;
    // a connection without a cookie had ended when its subscription was read
    if (!is_known || (one->first.cookie != 0 && is_open(one->first))) {
      ++one;
      continue;
    }
    if (!one->second.ended) one->second.ended = now;
    one = now - *one->second.ended >= kEnd ? connections_.erase(one) : std::next(one);
  }
}

namespace {

/// Throws Error if another file, or the socket of a running program, has this path: ZeroMQ would
/// remove it.
void require_free_ipc_path(const std::string& path) {
  const std::filesystem::file_status status = std::filesystem::status(path);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_socket(status)) {
    throw Error({"ipc://" + path, "a file that is not a socket has this name", "an unused name",
                 "choose another name"});
  }
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return;  // left by a program that was killed
  }
  throw Error({"ipc://" + path, "another program listens there", "an unused name",
               "end it, or choose another name"});
}

/// Receives ZeroMQ's events of a socket's connections. With a guard it uses its own thread, so that
/// limits apply even if the socket's thread is busy.
class SocketMonitor {
 public:
  /// `context` and `socket` are ZeroMQ's and must outlive it; `name` is unique in the context.
  SocketMonitor(void* context, void* socket, const std::string& name,
                std::unique_ptr<ConnectionGuard> guard);
  ~SocketMonitor();
  SocketMonitor(const SocketMonitor&) = delete;
  SocketMonitor& operator=(const SocketMonitor&) = delete;

  /// Events since the last call; to be called in the socket's thread.
  std::vector<PeerEvent> events();
  /// The guard, or nullptr.
  [[nodiscard]] ConnectionGuard* guard() { return guard_.get(); }

 private:
  void run();

  void* socket_;
  void* reports_;  ///< ZeroMQ's socket of events, used by the thread if there is one
  std::unique_ptr<ConnectionGuard> guard_;
  UniqueFd ending_;  ///< readable when the thread is to end
  std::thread thread_;
};

constexpr int kPeerEvents = ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_DISCONNECTED |
                            ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                            ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL;
constexpr int kGuardEvents =
    kPeerEvents | ZMQ_EVENT_LISTENING | ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_ACCEPT_FAILED;

struct Notice {
  std::uint16_t event = 0;
  std::int32_t value = 0;  ///< a descriptor or an error number
};

/// The next event: two parts, of which the second is an address.
std::optional<Notice> receive(void* reports) {
  std::array<std::byte, 6> bytes{};
  if (zmq_recv(reports, bytes.data(), bytes.size(), ZMQ_DONTWAIT) < 0) return std::nullopt;
  int more = 0;
  std::size_t size = sizeof(more);
  zmq_getsockopt(reports, ZMQ_RCVMORE, &more, &size);
  if (more != 0) zmq_recv(reports, nullptr, 0, 0);
  Notice notice;
  std::memcpy(&notice.event, bytes.data(), sizeof(notice.event));
  std::memcpy(&notice.value, bytes.data() + sizeof(notice.event), sizeof(notice.value));
  return notice;
}

PeerEvent peer_event(std::uint16_t event) {
  if (event == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) return PeerEvent::joined;
  return event == ZMQ_EVENT_DISCONNECTED ? PeerEvent::left : PeerEvent::refused;
}

void pass_on(const Notice& notice, ConnectionGuard& guard) {
  switch (notice.event) {
    case ZMQ_EVENT_LISTENING:
      return guard.on_listening(notice.value);
    case ZMQ_EVENT_ACCEPTED:
      return guard.on_accepted(notice.value);
    case ZMQ_EVENT_ACCEPT_FAILED:
      return guard.on_accept_failed(notice.value);
    case ZMQ_EVENT_HANDSHAKE_SUCCEEDED:
      return guard.on_joined();
    case ZMQ_EVENT_DISCONNECTED:
      return guard.on_left(notice.value);
    default:
      return guard.on_refused();
  }
}

[[noreturn]] void fail(const char* what) {
  throw Error({.where = "connections", .found = what});
}

SocketMonitor::SocketMonitor(void* context, void* socket, const std::string& name,
                             std::unique_ptr<ConnectionGuard> guard)
    : socket_(socket), reports_(zmq_socket(context, ZMQ_PAIR)), guard_(std::move(guard)) {
  const std::string address = "inproc://monitor-" + name;
  const int none = 0;
  if (reports_ == nullptr) fail("there are too many sockets");
  zmq_setsockopt(reports_, ZMQ_LINGER, &none, sizeof(none));
  zmq_setsockopt(reports_, ZMQ_RCVHWM, &none, sizeof(none));  // a full queue would block ZeroMQ
  if (zmq_socket_monitor(socket, address.c_str(), guard_ ? kGuardEvents : kPeerEvents) != 0 ||
      zmq_connect(reports_, address.c_str()) != 0) {
    zmq_close(reports_);
    fail(zmq_strerror(zmq_errno()));
  }
  if (!guard_) return;
  ending_ = UniqueFd(::eventfd(0, EFD_CLOEXEC));
  thread_ = std::thread([this] { run(); });
}

/// ZeroMQ's end is closed first, because it would wait for a closed peer.
SocketMonitor::~SocketMonitor() {
  zmq_socket_monitor(socket_, nullptr, 0);
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(ending_.get(), &one, sizeof(one));
    thread_.join();
  }
  zmq_close(reports_);
}

std::vector<PeerEvent> SocketMonitor::events() {
  if (guard_) return guard_->events();
  std::vector<PeerEvent> found;
  while (const std::optional<Notice> notice = receive(reports_)) {
    found.push_back(peer_event(notice->event));
  }
  return found;
}

void SocketMonitor::run() {
  constexpr int kMaxAtOnce = 1000;  // ZeroMQ reports endlessly while it cannot accept
  std::array<zmq_pollitem_t, 2> items = {
      zmq_pollitem_t{.socket = reports_, .fd = 0, .events = ZMQ_POLLIN, .revents = 0},
      zmq_pollitem_t{.socket = nullptr, .fd = ending_.get(), .events = ZMQ_POLLIN, .revents = 0}};
  auto looked = ConnectionGuard::Clock::now();
  HeapTrimmer trimmer;
  while (items[1].revents == 0) {
    const long idle_ms =
        trimmer.is_waiting() ? std::chrono::milliseconds(HeapTrimmer::kPause).count() : -1;
    const long at_most_ms =
        guard_->needs_check() ? ConnectionGuard::kCheckInterval.count() : idle_ms;
    zmq_poll(items.data(), static_cast<int>(items.size()), at_most_ms);
    for (int i = 0; i < kMaxAtOnce; ++i) {
      const std::optional<Notice> notice = receive(reports_);
      if (!notice) break;
      pass_on(*notice, *guard_);
      if (notice->event == ZMQ_EVENT_DISCONNECTED) trimmer.expect();
    }
    const auto now = ConnectionGuard::Clock::now();
    trimmer.check(now);
    if (now - looked < ConnectionGuard::kCheckInterval) continue;
    looked = now;
    guard_->check_limits();
  }
}

/// XPUB is a PUB that also reports subscriptions, but it cannot keep the newest message only.
zmq::socket_type type_of(const SocketOptions& options) {
  switch (options.kind) {
    case SocketKind::subscribe:
      return zmq::socket_type::sub;
    case SocketKind::request:
      return zmq::socket_type::req;
    case SocketKind::reply:
      return zmq::socket_type::rep;
    case SocketKind::router:
      return zmq::socket_type::router;
    case SocketKind::publish:
      break;
  }
  return options.keeps_newest ? zmq::socket_type::pub : zmq::socket_type::xpub;
}

std::chrono::milliseconds::rep millis(std::chrono::milliseconds time) {
  return time.count();
}

/// A payload owned by ZeroMQ, and the counter of these.
struct InFlight {
  Payload payload;
  std::shared_ptr<std::atomic<int>> count;
};

/// Returns a payload to its pool when ZeroMQ releases it, in ZeroMQ's thread.
void release(void* /*bytes*/, void* in_flight) {
  --*static_cast<InFlight*>(in_flight)->count;
  delete static_cast<InFlight*>(in_flight);
}

/// Releases the owner of the bytes of a part.
void release_owner(void* /*bytes*/, void* owner) {
  delete static_cast<std::shared_ptr<const void>*>(owner);
}

/// The result of an action, which is repeated if a signal interrupts it.
template <class Action>
auto retry_if_interrupted(const Action& action) {
  for (;;) {
    try {
      return action();
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR) throw;
    }
  }
}

/// The descriptor of a message's connection. The end of a subscription has none if the connection
/// ended before.
int connection_of(const zmq::message_t& message) {
  const int descriptor = zmq_msg_get(message.handle(), ZMQ_SRCFD);
  return descriptor < 0 ? SubscriptionTable::kUnknownConnection.descriptor : descriptor;
}

/// Makes ZeroMQ process pending events, which it does only when the socket is used.
void process_events(zmq::socket_t& socket) {
  (void)retry_if_interrupted([&socket] { return socket.get(zmq::sockopt::events); });
}

}  // namespace

CurveKeys make_curve_keys() {
  constexpr std::size_t kLetters = 40;
  std::array<char, kLetters + 1> public_key{};
  std::array<char, kLetters + 1> secret_key{};
  if (zmq_curve_keypair(public_key.data(), secret_key.data()) != 0) throw zmq::error_t();
  return {public_key.data(), secret_key.data()};
}

struct Context::Impl {
  zmq::context_t context{1};
  std::atomic<std::uint64_t> sockets{0};  ///< created so far
};

Context::Context() : impl_(std::make_unique<Impl>()) {}
Context::~Context() = default;

struct Message::Impl {
  zmq::message_t message;
  bool is_part = false;
  bool is_last = true;
  std::uint64_t cookie = 0;
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

ConnectionId Message::connection() const {
  return {connection_of(impl_->message), impl_->cookie};
}

struct Socket::Impl {
  zmq::socket_t socket;
  std::unique_ptr<SocketMonitor> monitor;  ///< destroyed before the socket
  bool follows_part = false;
  SubscriptionTable subscriptions;
  SubscriptionLimits subscription_limits;
  int send_queue;
  std::shared_ptr<std::atomic<int>> in_flight = std::make_shared<std::atomic<int>>(0);
  bool is_behind = false;  ///< a subscriber's queue was full

  Impl(zmq::context_t& context, const SocketOptions& options)
      : socket(context, type_of(options)),
        subscription_limits(options.subscriptions),
        send_queue(options.send_queue) {}

  [[nodiscard]] ConnectionGuard* guard() const { return monitor ? monitor->guard() : nullptr; }
  /// To be called before ZeroMQ reads received data, which it does whenever the socket is used.
  void refuse_who_sent_too_much() const {
    if (guard() != nullptr) guard()->check_limits();
  }
  void forget_ended() {
    if (guard() == nullptr) return;
    subscriptions.forget_ended([this](const ConnectionId& one) { return guard()->is_open(one); },
                               SubscriptionTable::Clock::now());
  }
};

namespace {

/// The kernel detects connections that ended without notice, after some minutes.
void protect(zmq::socket_t& socket, const ConnectionLimits& limits) {
  constexpr int kSocketBacklog = 64;
  constexpr int kIdle_s = 60;
  const std::chrono::milliseconds handshake = limits.handshake;
  socket.set(zmq::sockopt::handshake_ivl, static_cast<int>(millis(handshake)));
  socket.set(zmq::sockopt::backlog, kSocketBacklog);
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::tcp_keepalive_idle, kIdle_s);
}

std::unique_ptr<SocketMonitor> make_monitor(zmq::context_t& context, zmq::socket_t& socket,
                                            const SocketOptions& options, std::uint64_t number) {
  if (!options.reports_events && !options.protection) return nullptr;
  std::unique_ptr<ConnectionGuard> guard;
  if (options.protection) {
    protect(socket, options.protection->limits);
    guard = std::make_unique<ConnectionGuard>(options.protection->limits,
                                              options.protection->errors, options.reports_events);
  }
  return std::make_unique<SocketMonitor>(context.handle(), socket.handle(), std::to_string(number),
                                         std::move(guard));
}

/// Without descriptors for its threads, queues and the monitor, ZeroMQ would end the program.
constexpr int kSocketDescriptors = 16;

zmq::context_t& with_descriptors(zmq::context_t& context) {
  require_descriptors(kSocketDescriptors);
  return context;
}

}  // namespace

Socket::Socket(Context& context, const SocketOptions& options)
    : impl_(std::make_unique<Impl>(with_descriptors(context.impl_->context), options)) {
  zmq::socket_t& socket = impl_->socket;
  socket.set(zmq::sockopt::linger, static_cast<int>(millis(options.linger)));
  socket.set(zmq::sockopt::sndhwm, options.send_queue);
  socket.set(zmq::sockopt::rcvhwm, options.receive_queue);
  socket.set(zmq::sockopt::maxmsgsize, options.max_message_bytes);
  if (options.keeps_newest) socket.set(zmq::sockopt::conflate, true);
  if (options.curve) {
    socket.set(zmq::sockopt::curve_server, 1);
    socket.set(zmq::sockopt::curve_secretkey, options.curve->secret_key);
  }
  if (options.kind == SocketKind::router) socket.set(zmq::sockopt::router_mandatory, true);
  if (type_of(options) == zmq::socket_type::xpub) socket.set(zmq::sockopt::xpub_verboser, 1);
  impl_->monitor = make_monitor(context.impl_->context, socket, options, context.impl_->sockets++);
}

Socket::~Socket() = default;
Socket::Socket(Socket&&) noexcept = default;
Socket& Socket::operator=(Socket&&) noexcept = default;

void Socket::bind(const Endpoint& endpoint) {
  if (!endpoint.path.empty()) require_free_ipc_path(endpoint.path);
  try {
    impl_->socket.bind(text_of(endpoint));
  } catch (const zmq::error_t& error) {
    fail_at(endpoint, error.num(), "listen there");
  }
}

void Socket::connect(const Endpoint& endpoint) {
  try {
    impl_->socket.connect(text_of(endpoint));
  } catch (const zmq::error_t& error) {
    fail_at(endpoint, error.num(), "connect to it");
  }
}

void Socket::subscribe(std::string_view topic) {
  impl_->socket.set(zmq::sockopt::subscribe, std::string(topic));
}

void Socket::set_linger(std::chrono::milliseconds linger) {
  impl_->socket.set(zmq::sockopt::linger, static_cast<int>(millis(linger)));
}

std::optional<Message> Socket::receive() {
  zmq::message_t received;
  const auto take = [&] { return impl_->socket.recv(received, zmq::recv_flags::dontwait); };
  if (!retry_if_interrupted(take)) return std::nullopt;
  Message message;
  const bool follows = std::exchange(impl_->follows_part, received.more());
  message.impl_->is_part = follows || received.more();
  message.impl_->is_last = !received.more();
  message.impl_->message = std::move(received);
  if (impl_->guard() != nullptr && message.is_last()) {
    message.impl_->cookie = impl_->guard()->delivered(message.connection().descriptor);
  }
  return message;
}

bool Socket::send(std::span<const std::byte> bytes) {
  zmq::message_t message(bytes.data(), bytes.size());
  const auto give = [&] { return impl_->socket.send(message, zmq::send_flags::dontwait); };
  return retry_if_interrupted(give).has_value();
}

namespace {

/// Does not block. A router refuses the first part if its peer has left or reads too slowly;
/// further parts are accepted.
Sending send_now(zmq::socket_t& socket, zmq::message_t& message, zmq::send_flags flags) {
  try {
    const auto give = [&] { return socket.send(message, flags | zmq::send_flags::dontwait); };
    return retry_if_interrupted(give) ? Sending::sent : Sending::queue_full;
  } catch (const zmq::error_t& error) {
    if (error.num() != EHOSTUNREACH) throw;
    return Sending::peer_gone;
  }
}

}  // namespace

Sending Socket::send_parts(std::span<const Part> parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto owner = std::make_unique<std::shared_ptr<const void>>(parts[i].owner);
    // ZeroMQ only reads these bytes.
    auto* bytes = const_cast<std::byte*>(parts[i].bytes.data());
    zmq::message_t message(bytes, parts[i].bytes.size(), release_owner, owner.get());
    owner.release();  // NOLINT(bugprone-unused-return-value): the message has it
    const auto flags = i + 1 < parts.size() ? zmq::send_flags::sndmore : zmq::send_flags::none;
    const Sending sending = send_now(impl_->socket, message, flags);
    if (sending != Sending::sent) return sending;
  }
  return Sending::sent;
}

std::string Socket::bound_to() const {
  return impl_->socket.get(zmq::sockopt::last_endpoint);
}

namespace {

/// Sends first only if all queues have room, so that a full one is detected; then to those that
/// have.
bool publish_now(zmq::socket_t& socket, zmq::message_t& message, zmq::send_flags flags) {
  process_events(socket);  // e.g. that a queue has room again
  socket.set(zmq::sockopt::xpub_nodrop, true);
  if (retry_if_interrupted([&] { return socket.send(message, flags); })) return true;
  socket.set(zmq::sockopt::xpub_nodrop, false);
  (void)retry_if_interrupted([&] { return socket.send(message, zmq::send_flags::dontwait); });
  return false;
}

}  // namespace

/// ZeroMQ reports a full queue once and then omits it until half of it is read. Messages in transit
/// count too, so that this may detect it late, but not early.
bool Socket::has_full_queue() const {
  impl_->is_behind = impl_->is_behind && *impl_->in_flight > impl_->send_queue / 2;
  return impl_->is_behind;
}

bool Socket::publish(Payload payload) {
  impl_->refuse_who_sent_too_much();
  const bool was_full = has_full_queue();
  auto owned = std::make_unique<InFlight>(InFlight{std::move(payload), impl_->in_flight});
  const std::span<std::byte> bytes = owned->payload.bytes();
  zmq::message_t message(bytes.data(), bytes.size(), release, owned.get());
  owned.release();  // NOLINT(bugprone-unused-return-value): the message has it
  ++*impl_->in_flight;
  if (publish_now(impl_->socket, message, zmq::send_flags::dontwait)) return !was_full;
  impl_->is_behind = true;
  return false;
}

bool Socket::publish(std::span<const std::byte> bytes, std::chrono::milliseconds timeout) {
  constexpr std::chrono::milliseconds kSocketWait{5};
  const auto until = std::chrono::steady_clock::now() + timeout;
  while (has_full_queue() && std::chrono::steady_clock::now() < until)
    wait_for({}, -1, kSocketWait);
  if (std::exchange(impl_->is_behind, false)) timeout = kSocketWait;  // one full wait is enough
  zmq::message_t message(bytes.data(), bytes.size());
  impl_->socket.set(zmq::sockopt::sndtimeo, static_cast<int>(millis(timeout)));
  return publish_now(impl_->socket, message, zmq::send_flags::none);
}

SubscriptionCount Socket::subscriptions(std::span<const std::string> topics) {
  if (impl_->socket.get(zmq::sockopt::type) != ZMQ_XPUB) return {};
  impl_->refuse_who_sent_too_much();
  constexpr int kMaxAtOnce = 1000;  // so that the caller is not blocked
  for (int i = 0; i < kMaxAtOnce; ++i) {
    const std::optional<Message> message = receive();
    if (!message) {
      impl_->forget_ended();
      break;
    }
    note_subscription(*message);
  }
  return {.is_known = true, .subscribers = impl_->subscriptions.subscribers(topics)};
}

/// The message is one byte, 1 for a subscription or 0 for its end, followed by the topic.
void Socket::note_subscription(const Message& message) {
  const SubscriptionLimits& limits = impl_->subscription_limits;
  const std::span<const std::byte> bytes = message.bytes();
  const ConnectionId connection = message.connection();
  if (bytes.empty() || std::to_integer<int>(bytes[0]) > 1) {
    return cut_off(connection, "peer refused",
                   "a peer sent a message to the cloud port, which accepts subscriptions only");
  }
  if (bytes.size() > 1 + limits.topic_bytes) {
    return cut_off(connection, "subscription limit",
                   "a topic has " + std::to_string(bytes.size() - 1) + " bytes; allowed are " +
                       std::to_string(limits.topic_bytes) + " (--limit topic-bytes)");
  }
  const std::string topic(reinterpret_cast<const char*>(bytes.data()) + 1, bytes.size() - 1);
  if (bytes[0] == std::byte{0}) return impl_->subscriptions.remove(connection, topic);
  if (impl_->subscriptions.add(connection, topic) <= limits.subscriptions) return;
  cut_off(connection, "subscription limit",
          "a peer has more than " + std::to_string(limits.subscriptions) +
              " subscriptions (--limit subscriptions)");
}

std::vector<PeerEvent> Socket::events() {
  if (!impl_->monitor) return {};
  std::vector<PeerEvent> found = impl_->monitor->events();
  impl_->refuse_who_sent_too_much();
  process_events(impl_->socket);  // ZeroMQ subscribes again to a peer that returned, before the
                                  // event is reported
  return found;
}

void Socket::cut_off(const ConnectionId& connection, const std::string& kind,
                     const std::string& why) {
  if (impl_->guard() != nullptr) impl_->guard()->cut_off(connection, kind, why);
}

std::uint64_t Socket::taken_bytes(const ConnectionId& connection) const {
  return impl_->guard() != nullptr ? impl_->guard()->taken_bytes(connection) : 0;
}

bool Socket::is_open(const ConnectionId& connection) const {
  return impl_->guard() == nullptr || impl_->guard()->is_open(connection);
}

bool wait_for(std::initializer_list<const Socket*> sockets, int descriptor,
              std::chrono::milliseconds at_most) {
  std::vector<zmq::pollitem_t> items;
  for (const Socket* socket : sockets) {
    if (socket != nullptr) items.push_back({socket->impl_->socket.handle(), 0, ZMQ_POLLIN, 0});
  }
  if (descriptor >= 0) items.push_back({nullptr, descriptor, ZMQ_POLLIN, 0});
  try {
    return zmq::poll(items, at_most) > 0;
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
    return false;
  }
}

namespace {

constexpr std::size_t kMaxEnvelopeParts = 8;
constexpr std::size_t kMaxEnvelopePart_bytes = 255;  // the maximum size of identities

/// Maximum number of malformed messages that one call discards.
constexpr int kMaxDiscarded = 64;

SocketOptions as_router(SocketOptions options) {
  options.kind = SocketKind::router;
  return options;
}

std::string text_of(const Message& message) {
  return {reinterpret_cast<const char*>(message.bytes().data()), message.bytes().size()};
}

}  // namespace

Part part_of(std::string bytes) {
  const auto owner = std::make_shared<const std::string>(std::move(bytes));
  return {.bytes = std::as_bytes(std::span(*owner)), .owner = owner};
}

Router::Router(Context& context, SocketOptions options, ErrorLog& errors)
    : errors_(errors), socket_(context, as_router(std::move(options))) {}

std::optional<Delivered> Router::receive() {
  for (int i = 0; i < kMaxDiscarded; ++i) {
    const std::optional<Message> identity = socket_.receive();
    if (!identity) return std::nullopt;
    if (std::optional<Delivered> delivered = read(*identity)) return delivered;
    errors_.report(
        "message discarded",
        "a peer sent a message without the empty part that precedes a request; use a REQ "
        "socket, or a DEALER that sends an empty part first");
  }
  return std::nullopt;
}

/// Reads all parts of a message, which arrive together.
std::optional<Delivered> Router::read(const Message& identity) {
  Delivered delivered{.from = {.client = text_of(identity)}, .body = {}};
  bool has_delimiter = false;
  bool has_body = false;
  for (bool is_last = identity.is_last(); !is_last;) {
    std::optional<Message> part = socket_.receive();
    if (!part) break;
    is_last = part->is_last();
    if (has_body) {
      delivered.is_single = false;
    } else if (has_delimiter) {
      delivered.from.connection = part->connection();
      delivered.body = std::move(*part);
      has_body = true;
    } else if (part->bytes().empty()) {
      has_delimiter = true;
    } else if (delivered.from.envelope.size() < kMaxEnvelopeParts &&
               part->bytes().size() <= kMaxEnvelopePart_bytes) {
      delivered.from.envelope.push_back(text_of(*part));
    } else {
      while (!is_last && (part = socket_.receive())) is_last = part->is_last();
    }
  }
  if (!has_body) return std::nullopt;
  return delivered;
}

Sending Router::reply(const ReturnAddress& to, std::span<const Part> parts) {
  std::vector<Part> all = {part_of(to.client)};
  for (const std::string& part : to.envelope) all.push_back(part_of(part));
  all.push_back({});  // the delimiter
  all.insert(all.end(), parts.begin(), parts.end());
  return socket_.send_parts(all);
}

}  // namespace glidar::link
