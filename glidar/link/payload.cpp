// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <algorithm>
#include <utility>

namespace glidar::link {

PayloadPool::Memory PayloadPool::take(std::size_t bytes) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(), [bytes](const Memory& memory) {
      return memory.capacity >= bytes;
    });
    if (found != kept_.end()) {
      Memory memory = std::move(*found);
      kept_.erase(found);
      return memory;
    }
    kept_.clear();  // too small for the current messages
  }
  return {std::unique_ptr<std::byte[]>(new std::byte[bytes]), bytes};  // NOLINT: uninitialised
}

void PayloadPool::recycle(Memory memory) {
  const std::lock_guard lock(mutex_);
  if (kept_.size() < kMaxKept) kept_.push_back(std::move(memory));
}

Payload::Payload(std::shared_ptr<PayloadPool> pool, std::size_t bytes)
    : pool_(std::move(pool)), memory_(pool_->take(bytes)), size_(bytes) {}

Payload::Payload(Payload&& other) noexcept
    : pool_(std::move(other.pool_)),
      memory_(std::move(other.memory_)),
      size_(std::exchange(other.size_, 0)) {}

Payload& Payload::operator=(Payload&& other) noexcept {
  std::swap(pool_, other.pool_);
  std::swap(memory_, other.memory_);
  std::swap(size_, other.size_);
  return *this;
}

Payload::~Payload() {
  if (pool_ && memory_.bytes) pool_->recycle(std::move(memory_));
}

void Payload::shrink(std::size_t bytes) {
  size_ = std::min(size_, bytes);
}

}  // namespace glidar::link
