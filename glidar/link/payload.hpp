// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace glidar::link {

/// Memory for messages, reused after they are sent: a message of a megabyte takes longer to
/// allocate than to fill. Payloads may be released in any thread, also after the pool is destroyed.
class PayloadPool {
 public:
  struct Memory {
    std::unique_ptr<std::byte[]> bytes;  // NOLINT(modernize-avoid-c-arrays): uninitialised
    std::size_t capacity = 0;
  };

  [[nodiscard]] Memory take(std::size_t bytes);
  void recycle(Memory memory);

 private:
  static constexpr std::size_t kMaxKept = 8;

  std::mutex mutex_;
  std::vector<Memory> kept_;
};

/// The bytes of one message, which are passed to the socket without a copy.
class Payload {
 public:
  Payload() = default;
  /// At least this number of bytes, of unspecified content.
  Payload(std::shared_ptr<PayloadPool> pool, std::size_t bytes);
  Payload(Payload&& other) noexcept;
  Payload& operator=(Payload&& other) noexcept;
  Payload(const Payload&) = delete;
  Payload& operator=(const Payload&) = delete;
  ~Payload();

  [[nodiscard]] std::span<std::byte> bytes() { return {memory_.bytes.get(), size_}; }
  /// Keeps the first `bytes` bytes.
  void shrink(std::size_t bytes);

 private:
  std::shared_ptr<PayloadPool> pool_;
  PayloadPool::Memory memory_;
  std::size_t size_ = 0;
};

}  // namespace glidar::link
