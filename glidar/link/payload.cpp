// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <utility>

namespace glidar::link {

Payload PayloadPool::payload_of(std::vector<std::byte> memory, std::size_t size) const {
  const auto recycle = [sent = sent_](std::vector<std::byte>* done) {
    const std::unique_ptr<std::vector<std::byte>> owned(done);
    sent->give_back(std::move(*owned));
  };
  const std::shared_ptr<std::vector<std::byte>> held(new std::vector(std::move(memory)), recycle);
  return {std::shared_ptr<std::byte[]>(held, held->data()), size};  // NOLINT: shared array
}

Payload PayloadPool::take(std::size_t bytes) {
  std::vector<std::byte> memory = sent_->take(bytes);
  if (memory.size() < bytes) memory.resize(bytes);  // zeros only beyond the message before it
  return payload_of(std::move(memory), bytes);
}

Payload PayloadPool::take(std::vector<std::byte>& bytes) {
  const std::size_t size = bytes.size();
  Payload payload = payload_of(std::move(bytes), size);
  bytes = sent_->take(size);
  return payload;
}

}  // namespace glidar::link
