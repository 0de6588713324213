// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/listener.hpp>

#include <fcntl.h>
#include <linux/filter.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

namespace glidar::link {
namespace {

int open_spare() {
  return ::open("/dev/null", O_RDONLY | O_CLOEXEC);
}

}  // namespace

Listener::Listener(int descriptor)
    : descriptor_(::fcntl(descriptor, F_DUPFD_CLOEXEC, 0)), spare_(open_spare()) {
  // ZeroMQ accepts after poll() and would block if discard_waiting() was faster.
  if (descriptor_ >= 0) {
    ::fcntl(descriptor_, F_SETFL, ::fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
  }
}

Listener::Listener(Listener&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      spare_(std::exchange(other.spare_, -1)),
      is_paused_(other.is_paused_) {}

Listener::~Listener() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (spare_ >= 0) ::close(spare_);
}

/// A packet filter that drops all packets (socket(7), SO_ATTACH_FILTER).
void Listener::pause() {
  sock_filter none = {.code = BPF_RET | BPF_K, .jt = 0, .jf = 0, .k = 0};
  const sock_fprog program = {.len = 1, .filter = &none};
  ::setsockopt(descriptor_, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof(program));
  is_paused_ = true;
}

void Listener::resume() {
  const int unused = 0;
  ::setsockopt(descriptor_, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof(unused));
  is_paused_ = false;
}

bool Listener::discard_waiting() {
  constexpr int kMaxAtOnce = 1024;
  if (spare_ >= 0) ::close(std::exchange(spare_, -1));
  int accepted = 0;
  for (int i = 0; i < kMaxAtOnce && accepted >= 0; ++i) {
    accepted = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
    if (accepted >= 0) ::close(accepted);
  }
  const bool is_done = accepted < 0 && errno == EAGAIN;
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

}  // namespace glidar::link
