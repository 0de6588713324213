// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace glidar::link {

/// The bytes of one message, which are passed to the socket without a copy.
struct Payload {
  std::shared_ptr<std::byte[]> memory;  // NOLINT(modernize-avoid-c-arrays): uninitialised
  std::size_t size = 0;

  [[nodiscard]] std::span<std::byte> bytes() const { return {memory.get(), size}; }
};

/// Memory for messages, reused after they are sent: a message of a megabyte takes longer to
/// allocate than to fill. Payloads may be released in any thread, also after the pool is destroyed.
class PayloadPool {
 public:
  /// At least this number of bytes, of unspecified content.
  [[nodiscard]] Payload take(std::size_t bytes);

 private:
  struct Memory {
    std::unique_ptr<std::byte[]> bytes;  // NOLINT(modernize-avoid-c-arrays): uninitialised
    std::size_t capacity = 0;
  };
  struct FreeList {
    std::mutex mutex;
    std::vector<Memory> memories;
  };
  Memory acquire(std::size_t bytes);

  std::shared_ptr<FreeList> kept_ = std::make_shared<FreeList>();
};

/// Makes payloads of vectors without a copy, and reuses the vectors after they are sent. Payloads
/// may be released in any thread, also after the pool is destroyed.
class VectorPool {
 public:
  /// Takes the bytes and leaves those of a message that was sent, or none.
  [[nodiscard]] Payload take(std::vector<std::byte>& bytes);

 private:
  struct FreeList {
    std::mutex mutex;
    std::vector<std::vector<std::byte>> vectors;
  };

  std::shared_ptr<FreeList> kept_ = std::make_shared<FreeList>();
};

}  // namespace glidar::link
