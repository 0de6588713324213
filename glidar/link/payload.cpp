// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/payload.hpp>

#include <utility>
#include <variant>

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

namespace {

std::size_t memory_bytes(const PointCloud& cloud) {
  std::size_t bytes = sizeof(PointCloud);
  for (const Column& column : cloud.columns) {
    bytes +=
        sizeof(Column) +
        std::visit([](const auto& values) { return values.capacity() * sizeof(*values.data()); },
                   column.values);
  }
  return bytes;
}

}  // namespace

std::shared_ptr<PointCloud> CloudPool::take() {
  std::unique_ptr<PointCloud> cloud;
  {
    const std::lock_guard lock(kept_->mutex);
    if (!kept_->clouds.empty()) {
      cloud = std::move(kept_->clouds.back());
      kept_->clouds.pop_back();
      kept_->bytes -= memory_bytes(*cloud);
    }
  }
  if (!cloud) cloud = std::make_unique<PointCloud>();
  const auto recycle = [kept = kept_](PointCloud* done) {
    std::unique_ptr<PointCloud> owned(done);
    const std::size_t bytes = memory_bytes(*owned);
    const std::lock_guard lock(kept->mutex);
    if (!kept->clouds.empty() && kept->bytes + bytes > kMaxKept_bytes) return;
    kept->clouds.push_back(std::move(owned));
    kept->bytes += bytes;
  };
  return {cloud.release(), recycle};
}

std::size_t CloudPool::kept_bytes() const {
  const std::lock_guard lock(kept_->mutex);
  return kept_->bytes;
}

}  // namespace glidar::link
