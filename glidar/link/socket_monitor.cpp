// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/socket_monitor.hpp>

#include <glidar/core/error.hpp>
#include <glidar/link/heap_trimmer.hpp>

#include <sys/eventfd.h>
#include <unistd.h>
#include <zmq.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

namespace glidar::link {
namespace {

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

}  // namespace

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

}  // namespace glidar::link
