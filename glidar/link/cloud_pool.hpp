// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>

#include <memory>
#include <mutex>
#include <vector>

namespace glidar::link {

/// Clouds whose memory is used again once nobody holds them. Clouds may be let go of in any thread,
/// also after the pool is gone.
class CloudPool {
 public:
  /// A cloud with whatever was in it before.
  [[nodiscard]] std::shared_ptr<PointCloud> take();

 private:
  struct Kept {
    std::mutex mutex;
    std::vector<std::unique_ptr<PointCloud>> clouds;
  };
  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

}  // namespace glidar::link
