// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

namespace glidar {

/// The size from which memory is worth reusing: a message of a megabyte takes longer to allocate
/// than to fill.
inline constexpr std::size_t kMinReused_bytes = 65'536;

/// Memory of large messages, reused after they are sent. All functions may be called in any thread.
class MemoryPool {
 public:
  /// The smallest memory in the pool with a capacity of `size` bytes, with unspecified content and
  /// size; an empty vector if there is none, and for sizes below kMinReused_bytes.
  [[nodiscard]] std::vector<std::byte> take(std::size_t size);
  /// Adds memory of at least kMinReused_bytes; the pool keeps the last eight.
  void give_back(std::vector<std::byte> memory);

 private:
  std::mutex mutex_;
  std::vector<std::vector<std::byte>> spare_;  ///< the last one given back at the end
};

}  // namespace glidar
