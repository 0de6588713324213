// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/listener.hpp>

#include <glidar/core/error.hpp>

#include <fcntl.h>
#include <linux/filter.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace glidar::link {
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

}  // namespace glidar::link
