// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/connection_guard.hpp>

#include <glidar/core/error.hpp>

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace glidar::link {
namespace {

constexpr std::int64_t kMax = 1'000'000;

constexpr std::array kKinds = {
    LimitKind{"connections", &Limits::connections, 1, kMax, "connections at each port"},
    LimitKind{"connections-per-s", &Limits::connections_per_s, 1, kMax,
              "new connections per second at each port, after a first burst of `connections`"},
    LimitKind{"handshake-s", &Limits::handshake_s, 1, 3600,
              "seconds within which a new connection completes ZeroMQ's handshake"},
    LimitKind{"request-mib", &Limits::request_mib, 1, 4096,
              "MiB of one request, and of what a client has sent of unfinished ones"},
    LimitKind{"requests", &Limits::requests, 1, kMax,
              "requests of one client that wait or whose replies it has not read"},
    LimitKind{"request-s", &Limits::request_s, 1, kMax,
              "seconds until a request is answered, and then until its reply is read"},
    LimitKind{"reply-mib", &Limits::reply_mib, 1, kMax, "MiB of one reply"},
    LimitKind{"memory-mib", &Limits::memory_mib, 1, kMax,
              "MiB of all requests that wait and all replies that are not read"},
    LimitKind{"subscriptions", &Limits::subscriptions, 1, kMax, "subscriptions of one connection"},
    LimitKind{"topic-bytes", &Limits::topic_bytes, 1, 255, "bytes of a topic"},
};

const LimitKind& kind_of(std::string_view name, std::string_view text) {
  const auto* const found = std::find_if(kKinds.begin(), kKinds.end(),
                                         [&](const LimitKind& kind) { return kind.name == name; });
  if (found != kKinds.end()) return *found;
  std::vector<std::string> names;
  std::string allowed;
  for (const LimitKind& kind : kKinds) {
    names.emplace_back(kind.name);
    allowed += (allowed.empty() ? "" : ", ") + names.back();
  }
  const std::string nearest = closest_match(std::string(name), names);
  throw Error({.where = "--limit",
               .found = "'" + std::string(text) + "'",
               .allowed = "NAME=VALUE with one of these names: " + allowed,
               .remedy = nearest.empty() ? "" : "did you mean " + nearest + "?"});
}

}  // namespace

std::span<const LimitKind> limit_kinds() {
  return kKinds;
}

void set_limit(Limits& limits, std::string_view text) {
  const std::size_t equals = text.find('=');
  const LimitKind& kind = kind_of(text.substr(0, equals), text);
  const std::string_view number =
      equals == std::string_view::npos ? std::string_view() : text.substr(equals + 1);
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || stop != number.data() + number.size() || value < kind.min ||
      value > kind.max) {
    throw Error({.where = "--limit " + std::string(kind.name),
                 .found = "'" + std::string(number) + "'",
                 .allowed = "a whole number from " + std::to_string(kind.min) + " to " +
                            std::to_string(kind.max) + ": " + std::string(kind.meaning),
                 .remedy = "for example --limit " + std::string(kind.name) + "=" +
                           std::to_string(Limits{}.*kind.value)});
  }
  limits.*kind.value = value;
}

std::string limit_text(const Limits& limits, std::int64_t Limits::*value) {
  const auto* const kind = std::find_if(kKinds.begin(), kKinds.end(),
                                        [&](const LimitKind& one) { return one.value == value; });
  return "at most " + std::to_string(limits.*value) + " (--limit " + std::string(kind->name) + ")";
}

namespace {

UniqueFd open_spare() {
  return UniqueFd(::open("/dev/null", O_RDONLY | O_CLOEXEC));
}

}  // namespace

Listener::Listener(int descriptor)
    : descriptor_(::fcntl(descriptor, F_DUPFD_CLOEXEC, 0)), spare_(open_spare()) {
  // ZeroMQ accepts after poll() and would block if discard_waiting() was faster.
  if (descriptor_) {
    ::fcntl(descriptor_.get(), F_SETFL, ::fcntl(descriptor_.get(), F_GETFL) | O_NONBLOCK);
  }
}

/// A packet filter that drops all packets (socket(7), SO_ATTACH_FILTER).
void Listener::pause() {
  sock_filter none = {.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = 0};
  const sock_fprog program = {.len = 1, .filter = &none};
  ::setsockopt(descriptor_.get(), SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program));
  is_paused_ = true;
}

void Listener::resume() {
  const int unused = 0;
  ::setsockopt(descriptor_.get(), SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof(unused));
  is_paused_ = false;
}

bool Listener::discard_waiting() {
  constexpr int kMaxAtOnce = 1024;
  spare_.reset();
  bool is_done = false;
  for (int i = 0; i < kMaxAtOnce; ++i) {
    const UniqueFd accepted(::accept4(descriptor_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (accepted) continue;
    is_done = errno == EAGAIN;
    break;
  }
  spare_ = open_spare();
  return is_done;
}

void raise_descriptor_limit(std::int64_t connections) {
  constexpr std::int64_t kForFiles = 512;  // and other descriptors
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  const auto wanted = static_cast<rlim_t>(connections + kForFiles);
  if (limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min(limit.rlim_max, wanted);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

int descriptor_limit() {
  rlimit limit{};
  constexpr rlim_t kMaxConnections = std::numeric_limits<int>::max();
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return static_cast<int>(kMaxConnections);
  return static_cast<int>(std::min(limit.rlim_cur, kMaxConnections));
}

void require_descriptors(int count) {
  std::vector<UniqueFd> spare;
  while (std::ssize(spare) < count) {
    spare.push_back(open_spare());
    if (spare.back()) continue;
    throw Error({.where = "network",
                 .found = std::string("no free file descriptors: ") + std::strerror(errno),
                 .allowed = std::to_string(count) + " free ones; the limit of this process is " +
                            std::to_string(descriptor_limit()),
                 .remedy = "raise the limit, for example by 'ulimit -n 1024'"});
  }
}

namespace {

/// Allowance for ZeroMQ's handshake.
constexpr std::uint64_t kFreeBytes = 4096;

/// Connections that have requested nothing for this time may be closed for new ones.
constexpr std::chrono::seconds kGrace{1};

/// Connections that may have been accepted before new ones were blocked.
constexpr std::size_t kBacklog = 64;

/// Descriptors reserved for writing files.
constexpr int kLastDescriptors = 8;

/// Identifies a socket as long as the system runs; 0: the descriptor is no socket.
std::uint64_t cookie_of(int descriptor) {
  std::uint64_t cookie = 0;
  socklen_t size = sizeof(cookie);
  return ::getsockopt(descriptor, SOL_SOCKET, SO_COOKIE, &cookie, &size) == 0 ? cookie : 0;
}

/// The kernel's counters of a TCP connection; zeros for others.
tcp_info info_of(int descriptor) {
  tcp_info info{};
  socklen_t size = sizeof(info);
  if (::getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  return info;
}

/// Bytes that the kernel has received, read or not.
std::uint64_t received_bytes(int descriptor) {
  return info_of(descriptor).tcpi_bytes_received;
}

/// Closes a connection. Another socket that has got its descriptor meanwhile is not affected.
void shut_down(int descriptor, std::uint64_t cookie) {
  const UniqueFd held(::fcntl(descriptor, F_DUPFD_CLOEXEC, 0));  // so that the number is not reused
  const int used = held ? held.get() : descriptor;
  if (cookie_of(used) == cookie) {
    // Connecting to AF_UNSPEC resets a TCP connection and drops unread data (Linux,
    // tcp_disconnect); other kinds of connections reject it.
    const sockaddr nobody = {.sa_family = AF_UNSPEC, .sa_data = {}};
    if (::connect(used, &nobody, sizeof(nobody)) != 0) ::shutdown(used, SHUT_RDWR);
  }
}

/// Descriptors left for files and other sockets.
int reserved_descriptors() {
  return std::clamp(descriptor_limit() / 4, 16, 256);
}

bool has_few_descriptors() {
  const UniqueFd next(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0));
  return !next || next.get() >= descriptor_limit() - reserved_descriptors();
}

}  // namespace

ConnectionLimits connection_limits(const Limits& limits, std::uint64_t unread_bytes,
                                   std::uint64_t all_unread_bytes) {
  return {.connections = static_cast<std::size_t>(limits.connections),
          .connections_per_s = static_cast<double>(limits.connections_per_s),
          .handshake = std::chrono::seconds(limits.handshake_s),
          .unread_bytes = unread_bytes,
          .all_unread_bytes = all_unread_bytes};
}

ConnectionGuard::ConnectionGuard(const ConnectionLimits& limits, ErrorLog& errors,
                                 bool keeps_events)
    : limits_(limits),
      errors_(errors),
      keeps_events_(keeps_events),
      allowance_(burst()),
      refilled_(Clock::now()) {}

void ConnectionGuard::on_listening(int descriptor) {
  const std::lock_guard lock(mutex_);
  listener_.emplace(descriptor);
}

ConnectionGuard::Connection& ConnectionGuard::find_or_add(int descriptor) {
  Connection& connection = connections_[descriptor];
  const std::uint64_t cookie = cookie_of(descriptor);
  if (connection.cookie != cookie || cookie == 0) {
    connection = {.cookie = cookie, .since = Clock::now()};
  }
  return connection;
}

void ConnectionGuard::on_accepted(int descriptor) {
  const std::lock_guard lock(mutex_);
  find_or_add(descriptor);
  allowance_ -= 1.0;
  const int last = descriptor_limit() - kLastDescriptors;
  if (descriptor >= descriptor_limit() - reserved_descriptors()) hold_back_for_lack();
  if (is_full()) hold_back();
  if (descriptor >= last || open_connections() > 2 * limits_.connections + kBacklog) {
    cut(connections_.find(descriptor), "", "");
  }
  if (allowance_ >= 1.0 || is_held_back()) return;
  hold_back();
  errors_.report("connection rate",
                 "more than " + std::to_string(static_cast<int>(limits_.connections_per_s)) +
                     " new connections per second (--limit connections-per-s); further ones wait");
}

void ConnectionGuard::on_accept_failed(int error) {
  if (error != EMFILE && error != ENFILE) return;
  const std::lock_guard lock(mutex_);
  free_descriptors();
}

void ConnectionGuard::on_joined() {
  const std::lock_guard lock(mutex_);
  note(PeerEvent::joined);
}

void ConnectionGuard::on_left(int descriptor) {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(descriptor);
  // Another connection may have the descriptor by now; a connection that is just ending is removed
  // by the next check.
  if (found != connections_.end() && cookie_of(descriptor) != found->second.cookie) {
    connections_.erase(found);
  }
  if (!std::exchange(is_refused_, false)) note(PeerEvent::left);
}

/// The next event of ZeroMQ is that the connection ended.
void ConnectionGuard::on_refused() {
  const std::lock_guard lock(mutex_);
  is_refused_ = true;
  if (events_.empty() || events_.back() != PeerEvent::refused) {  // one event is enough
    note(PeerEvent::refused);
  }
}

void ConnectionGuard::check_limits() {
  const std::lock_guard lock(mutex_);
  std::erase_if(connections_, [](const auto& entry) {
    return cookie_of(entry.first) != entry.second.cookie;  // it has ended
  });
  check_unread();
  refill(Clock::now());
  lacks_descriptors_ = lacks_descriptors_ && has_few_descriptors();
  if (is_full()) make_room();
  const double needed = std::max(1.0, burst() / 10.0);
  if (is_held_back() && !is_full() && allowance_ >= needed) listener_->resume();
}

bool ConnectionGuard::needs_check() const {
  const std::lock_guard lock(mutex_);
  return !connections_.empty() || (listener_ && listener_->is_paused());
}

std::uint64_t ConnectionGuard::delivered(int descriptor) {
  const std::lock_guard lock(mutex_);
  // A message may arrive before the event that its connection was accepted, and after its end.
  if (cookie_of(descriptor) == 0) return 0;
  Connection& connection = find_or_add(descriptor);
  if (!limits_.counts_delivered) connection.read_bytes = received_bytes(descriptor);
  connection.has_delivered = true;
  return connection.cookie;
}

void ConnectionGuard::cut_off(const ConnectionId& connection, const std::string& kind,
                              const std::string& why) {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(connection.descriptor);
  if (found == connections_.end() || found->second.is_cut) return;
  if (connection.cookie == 0 || connection.cookie == found->second.cookie) cut(found, kind, why);
}

bool ConnectionGuard::is_open(const ConnectionId& connection) const {
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(connection.descriptor);
  return connection.cookie == 0 ||
         (found != connections_.end() && found->second.cookie == connection.cookie &&
          !found->second.is_cut);
}

std::uint64_t ConnectionGuard::taken_bytes(const ConnectionId& connection) const {
  return is_open(connection) ? info_of(connection.descriptor).tcpi_bytes_acked : 0;
}

std::vector<PeerEvent> ConnectionGuard::events() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

void ConnectionGuard::note(PeerEvent event) {
  if (keeps_events_) events_.push_back(event);
}

void ConnectionGuard::refill(Clock::time_point now) {
  const std::chrono::duration<double> passed = now - std::exchange(refilled_, now);
  allowance_ = std::min(allowance_ + passed.count() * limits_.connections_per_s, burst());
}

/// Connections that may be accepted at once.
double ConnectionGuard::burst() const {
  return std::max(static_cast<double>(limits_.connections), limits_.connections_per_s);
}

bool ConnectionGuard::is_full() const {
  return lacks_descriptors_ || open_connections() >= limits_.connections;
}

/// Closes the oldest connection that has requested nothing, to make room for a new one.
void ConnectionGuard::make_room() {
  const Clock::time_point latest = Clock::now() - kGrace;
  for (std::size_t open = open_connections(); is_full() && open > 0; --open) {
    auto victim = connections_.end();
    for (auto one = connections_.begin(); one != connections_.end(); ++one) {
      const Connection& connection = one->second;
      if (connection.is_cut || connection.has_delivered || connection.since > latest) continue;
      if (victim == connections_.end() || connection.since < victim->second.since) victim = one;
    }
    if (victim == connections_.end()) return;
    cut(victim, "connection limit",
        "at most " + std::to_string(limits_.connections) +
            " connections at a port (--limit connections): one without a request was closed");
    if (lacks_descriptors_) return;  // one per call: its descriptor is not free yet
  }
}

bool ConnectionGuard::is_held_back() const {
  return listener_ && listener_->is_paused();
}

void ConnectionGuard::hold_back() {
  if (listener_ && !listener_->is_paused()) listener_->pause();
}

/// Blocks new connections until there is room.
void ConnectionGuard::hold_back_for_lack() {
  report_descriptors();
  lacks_descriptors_ = true;
  hold_back();
}

/// Closes the newest connections, so that files can still be written.
void ConnectionGuard::free_descriptors() {
  hold_back_for_lack();
  const int first = descriptor_limit() - reserved_descriptors();
  for (auto one = connections_.lower_bound(first); one != connections_.end(); ++one) {
    if (!one->second.is_cut) cut(one, "", "");
  }
  if (listener_) listener_->discard_waiting();
}

void ConnectionGuard::report_descriptors() {
  const char* const kind = "file descriptors used up";
  if (errors_.counts().count(kind) > 0) return;  // once for all ports
  errors_.report(
      kind, "of " + std::to_string(descriptor_limit()) +
                ", the last ones are reserved for files; new connections are closed. Raise the "
                "limit (ulimit -n) or lower --limit connections");
}

/// Closes connections with an endless message, too many unread messages, or more bytes than such
/// peers need.
void ConnectionGuard::check_unread() {
  const Clock::time_point now = Clock::now();
  std::uint64_t all = 0;
  std::uint64_t max_unread = 0;
  auto largest = connections_.end();
  for (auto one = connections_.begin(); one != connections_.end(); ++one) {
    const Connection& connection = one->second;
    if (connection.is_cut) continue;
    const std::chrono::duration<double> age = now - connection.since;
    const std::uint64_t read = connection.read_bytes + kFreeBytes +
                               static_cast<std::uint64_t>(age.count() * limits_.free_bytes_per_s);
    const std::uint64_t received = received_bytes(one->first);
    const std::uint64_t unread = received > read ? received - read : 0;
    if (unread > limits_.unread_bytes) {
      cut(one, "peer cut off",
          "it sent " + std::to_string(unread) +
              (limits_.counts_delivered ? " bytes" : " bytes without a complete message") +
              "; allowed are " + std::to_string(limits_.unread_bytes));
      continue;
    }
    all += unread;
    if (unread > std::exchange(max_unread, std::max(max_unread, unread))) largest = one;
  }
  if (all <= limits_.all_unread_bytes) return;
  cut(largest, "peer cut off",
      "unfinished messages of all peers have " + std::to_string(all) + " bytes, allowed are " +
          std::to_string(limits_.all_unread_bytes) + "; it sent the most");
}

void ConnectionGuard::cut(Connections::iterator connection, const std::string& kind,
                          const std::string& why) {
  connection->second.is_cut = true;
  shut_down(connection->first, connection->second.cookie);
  if (!kind.empty()) errors_.report(kind, why);
}

std::size_t ConnectionGuard::open_connections() const {
  return static_cast<std::size_t>(
      std::count_if(connections_.begin(), connections_.end(),
                    [](const auto& entry) { return !entry.second.is_cut; }));
}

}  // namespace glidar::link
