// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>

#include <memory>
#include <mutex>
#include <vector>

namespace glidar::link {

/// Clouds whose memory is reused after their last reference is released, in any thread, also after
/// the pool is destroyed.
class CloudPool {
 public:
  /// A cloud with unspecified content.
  [[nodiscard]] std::shared_ptr<PointCloud> take();

 private:
  struct FreeList {
    std::mutex mutex;
    std::vector<std::unique_ptr<PointCloud>> clouds;
  };
  std::shared_ptr<FreeList> kept_ = std::make_shared<FreeList>();
};

}  // namespace glidar::link
