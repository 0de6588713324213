// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/shared_ring.hpp>

#include <glidar/core/error.hpp>

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace glidar {

struct SharedRing::Shared {
  std::atomic<std::uint32_t> taken;       ///< modulo 2^32
  std::atomic<std::uint32_t> is_waiting;  ///< the end that puts, for space
  alignas(4096) std::array<std::byte, kBytes> bytes;
};

namespace {

/// The standard's wait() and notify_one() work within one process only.
void futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value) {
  ::syscall(SYS_futex, &word, operation, value, nullptr, nullptr, 0);
}

}  // namespace

int SharedRing::create() {
  const int memory = ::memfd_create("glidar-records", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  constexpr int kFixedSize = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
  if (memory < 0 ||
      (::ftruncate(memory, sizeof(Shared)) == 0 && ::fcntl(memory, F_ADD_SEALS, kFixedSize) == 0))
    return memory;
  const int error = errno;
  ::close(memory);
  errno = error;
  return -1;
}

SharedRing::SharedRing(int fd) {
  void* mapped = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (mapped == MAP_FAILED) throw Error({"shared memory", std::generic_category().message(errno)});
  shared_ = static_cast<Shared*>(mapped);
}

SharedRing::~SharedRing() {
  ::munmap(shared_, sizeof(Shared));
}

std::uint32_t SharedRing::space() const {
  return kBytes - (at_ - shared_->taken.load());
}

std::size_t SharedRing::put(std::span<const std::byte> bytes) {
  const std::size_t count = std::min<std::size_t>(bytes.size(), space());
  const std::size_t start = at_ % kBytes;
  const std::size_t first = std::min(count, kBytes - start);
  std::memcpy(shared_->bytes.data() + start, bytes.data(), first);
  std::memcpy(shared_->bytes.data(), bytes.data() + first, count - first);
  at_ += static_cast<std::uint32_t>(count);
  return count;
}

void SharedRing::wait_for_space() {
  while (space() == 0) {
    shared_->is_waiting = 1;
    // returns at once when bytes were taken meanwhile
    futex(shared_->taken, FUTEX_WAIT, at_ - kBytes);
  }
}

void SharedRing::take(std::span<std::byte> to) {
  const std::size_t start = at_ % kBytes;
  const std::size_t first = std::min(to.size(), kBytes - start);
  std::memcpy(to.data(), shared_->bytes.data() + start, first);
  std::memcpy(to.data() + first, shared_->bytes.data(), to.size() - first);
  at_ += static_cast<std::uint32_t>(to.size());
  shared_->taken = at_;
  if (shared_->is_waiting.exchange(0) != 0) futex(shared_->taken, FUTEX_WAKE, 1);
}

}  // namespace glidar
