// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/unfinished_files.hpp>

#include <glidar/io/files/atomic_file.hpp>

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

namespace glidar {
namespace {

constexpr std::size_t kSlots = 128;
constexpr std::size_t kSlotPathBytes = 4096;

// States of a slot; int, because only plain atomics are sure to work in a signal handler.
constexpr int kFree = 0;
constexpr int kFilling = 1;
constexpr int kListed = 2;
constexpr int kRemoving = 3;

/// A temporary file's name in memory that a signal handler can read without allocation and locks.
struct Slot {
  std::atomic<int> state{kFree};
  std::array<char, kSlotPathBytes> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "used in signal handlers");

// Global, because a signal handler has no arguments.
constinit std::array<Slot, kSlots> unfinished{};

}  // namespace

int list_unfinished(const std::string& path) {
  if (path.size() >= kSlotPathBytes) return -1;
  for (std::size_t i = 0; i < kSlots; ++i) {
    int expected = kFree;
    if (!unfinished[i].state.compare_exchange_strong(expected, kFilling)) continue;
    std::memcpy(unfinished[i].path.data(), path.c_str(), path.size() + 1);
    unfinished[i].state.store(kListed);
    return static_cast<int>(i);
  }
  return -1;
}

/// A slot that a handler is reading is not changed, because the process is ending.
void unlist_unfinished(int slot) {
  if (slot < 0) return;
  int expected = kListed;
  unfinished[static_cast<std::size_t>(slot)].state.compare_exchange_strong(expected, kFree);
}

void remove_unfinished_files() noexcept {
  const int saved_errno = errno;
  for (Slot& slot : unfinished) {
    int expected = kListed;
    if (slot.state.compare_exchange_strong(expected, kRemoving)) ::unlink(slot.path.data());
  }
  // Folders without other files are empty now, the innermost first; for files this fails.
  for (std::size_t i = kSlots; i-- > 0;) {
    if (unfinished[i].state.load() == kRemoving) ::rmdir(unfinished[i].path.data());
  }
  errno = saved_errno;
}

}  // namespace glidar
