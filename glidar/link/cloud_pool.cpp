// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/cloud_pool.hpp>

#include <utility>

namespace glidar::link {

std::shared_ptr<PointCloud> CloudPool::take() {
  constexpr std::size_t kMaxKept = 256;
  std::unique_ptr<PointCloud> cloud;
  {
    const std::lock_guard lock(kept_->mutex);
    if (!kept_->clouds.empty()) {
      cloud = std::move(kept_->clouds.back());
      kept_->clouds.pop_back();
    }
  }
  if (!cloud) cloud = std::make_unique<PointCloud>();
  const auto recycle = [kept = kept_](PointCloud* done) {
    std::unique_ptr<PointCloud> owned(done);
    const std::lock_guard lock(kept->mutex);
    if (kept->clouds.size() < kMaxKept) kept->clouds.push_back(std::move(owned));
  };
  return {cloud.release(), recycle};
}

}  // namespace glidar::link
