// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/cloud_pool.hpp>

#include <utility>
#include <variant>

namespace glidar::link {
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
