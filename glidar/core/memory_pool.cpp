// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/memory_pool.hpp>

#include <utility>

namespace glidar {

std::vector<std::byte> MemoryPool::take(std::size_t size) {
  if (size < kMinReused_bytes) return {};
  const std::lock_guard lock(mutex_);
  auto best = spare_.end();
  for (auto memory = spare_.begin(); memory != spare_.end(); ++memory) {
    const bool fits = memory->capacity() >= size;
    if (fits && (best == spare_.end() || memory->capacity() < best->capacity())) best = memory;
  }
  if (best == spare_.end()) return {};
  std::vector<std::byte> memory = std::move(*best);
  spare_.erase(best);
  return memory;
}

void MemoryPool::give_back(std::vector<std::byte> memory) {
  constexpr std::size_t kMaxSpare = 8;
  if (memory.capacity() < kMinReused_bytes) return;
  std::vector<std::byte> outdated;  // freed after the lock
  const std::lock_guard lock(mutex_);
  if (spare_.size() == kMaxSpare) {
    outdated = std::move(spare_.front());
    spare_.erase(spare_.begin());
  }
  spare_.push_back(std::move(memory));
}

}  // namespace glidar
