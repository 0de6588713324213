// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <algorithm>
#include <utility>

namespace glidar::link {

PayloadPool::Memory PayloadPool::acquire(std::size_t bytes) {
  const std::lock_guard lock(kept_->mutex);
  std::vector<Memory>& memories = kept_->memories;
  const auto found = std::find_if(memories.begin(), memories.end(), [bytes](const Memory& memory) {
    return memory.capacity >= bytes;
  });
  if (found != memories.end()) {
    Memory memory = std::move(*found);
    memories.erase(found);
    return memory;
  }
  memories.clear();  // too small for the current messages
  return {std::unique_ptr<std::byte[]>(new std::byte[bytes]), bytes};  // NOLINT: uninitialised
}

Payload PayloadPool::take(std::size_t bytes) {
  constexpr std::size_t kMaxKept = 8;
  Memory memory = acquire(bytes);
  const auto recycle = [kept = kept_, capacity = memory.capacity](std::byte* done) {
    Memory owned{std::unique_ptr<std::byte[]>(done), capacity};  // NOLINT: uninitialised
    const std::lock_guard lock(kept->mutex);
    if (kept->memories.size() < kMaxKept) kept->memories.push_back(std::move(owned));
  };
  return {{memory.bytes.release(), recycle}, bytes};
}

Payload VectorPool::take(std::vector<std::byte>& bytes) {
  constexpr std::size_t kMaxKept = 8;
  const auto recycle = [kept = kept_](std::vector<std::byte>* done) {
    const std::unique_ptr<std::vector<std::byte>> owned(done);
    const std::lock_guard lock(kept->mutex);
    if (kept->vectors.size() < kMaxKept) kept->vectors.push_back(std::move(*owned));
  };
  const std::size_t size = bytes.size();
  const std::shared_ptr<std::vector<std::byte>> sent(new std::vector(std::move(bytes)), recycle);
  bytes.clear();
  const std::lock_guard lock(kept_->mutex);
  std::vector<std::vector<std::byte>>& vectors = kept_->vectors;
  const auto found = std::find_if(vectors.begin(), vectors.end(),
                                  [size](const auto& vector) { return vector.capacity() >= size; });
  if (found != vectors.end()) {
    bytes = std::move(*found);
    vectors.erase(found);
  } else {
    vectors.clear();  // too small for the current messages
  }
  return {std::shared_ptr<std::byte[]>(sent, sent->data()), size};  // NOLINT: shared array
}

}  // namespace glidar::link
