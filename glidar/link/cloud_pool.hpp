// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace glidar::link {

/// Clouds whose memory is reused after their last reference is released, in any thread, also after
/// the pool is destroyed. Of the released ones it keeps kMaxKept_bytes, or one larger cloud.
class CloudPool {
 public:
  static constexpr std::size_t kMaxKept_bytes = std::size_t{64} << 20U;

  /// A cloud with unspecified content.
  [[nodiscard]] std::shared_ptr<PointCloud> take();
  /// Memory of the clouds that wait for their reuse.
  [[nodiscard]] std::size_t kept_bytes() const;

 private:
  struct FreeList {
    std::mutex mutex;
    std::vector<std::unique_ptr<PointCloud>> clouds;
    std::size_t bytes = 0;  ///< of all of them
  };
  std::shared_ptr<FreeList> kept_ = std::make_shared<FreeList>();
};

}  // namespace glidar::link
