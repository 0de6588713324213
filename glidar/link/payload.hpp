// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/memory_pool.hpp>
#include <glidar/core/point_cloud.hpp>

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace glidar::link {

/// The bytes of one message, which are passed to the socket without a copy.
struct Payload {
  std::shared_ptr<std::byte[]> memory;  // NOLINT(modernize-avoid-c-arrays): unspecified content
  std::size_t size = 0;

  [[nodiscard]] std::span<std::byte> bytes() const { return {memory.get(), size}; }
};

/// Makes payloads, whose memory is reused after they are sent. Payloads may be released in any
/// thread, also after the pool is destroyed.
class PayloadPool {
 public:
  /// This number of bytes, of unspecified content.
  [[nodiscard]] Payload take(std::size_t bytes);
  /// Takes the bytes without a copy, and leaves those of a message that was sent, or none.
  [[nodiscard]] Payload take(std::vector<std::byte>& bytes);

 private:
  [[nodiscard]] Payload payload_of(std::vector<std::byte> memory, std::size_t size) const;

  std::shared_ptr<MemoryPool> sent_ = std::make_shared<MemoryPool>();
};

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
