// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace glidar::link {

/// Memory for messages, used again once they are sent: a message of a megabyte costs more to
/// allocate than to fill. Payloads may be given back from any thread, also after the pool is gone.
class PayloadPool {
 public:
  struct Memory {
    std::unique_ptr<std::byte[]> bytes;  // NOLINT(modernize-avoid-c-arrays): left unfilled
    std::size_t capacity = 0;
  };

  [[nodiscard]] Memory take(std::size_t bytes);
  void give_back(Memory memory);

 private:
  static constexpr std::size_t kMaxKept = 8;

  std::mutex mutex_;
  std::vector<Memory> kept_;
};

/// The bytes of one message on their way from who writes them to the socket, without a copy.
class Payload {
 public:
  Payload() = default;
  /// At least so many bytes, of unspecified content.
  Payload(std::shared_ptr<PayloadPool> pool, std::size_t bytes);
  Payload(Payload&& other) noexcept;
  Payload& operator=(Payload&& other) noexcept;
  Payload(const Payload&) = delete;
  Payload& operator=(const Payload&) = delete;
  ~Payload();

  [[nodiscard]] std::span<std::byte> bytes() { return {memory_.bytes.get(), size_}; }
  /// Keeps the first so many bytes.
  void shrink(std::size_t bytes);

 private:
  std::shared_ptr<PayloadPool> pool_;
  PayloadPool::Memory memory_;
  std::size_t size_ = 0;
};

}  // namespace glidar::link
