// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io and glidar-import.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar {

/// A ring of bytes in memory that two processes share: one of them puts bytes, the other one takes
/// them, and a pipe between them states how many there are. It costs less than half of a pipe,
/// which allocates its pages for each write.
class SharedRing {
 public:
  static constexpr std::uint32_t kBytes = std::uint32_t{1} << 19U;

  /// Creates the memory, whose size cannot change: a descriptor, or -1 and errno.
  static int create();
  /// Maps it, at both ends. Throws Error.
  explicit SharedRing(int fd);
  SharedRing(const SharedRing&) = delete;
  SharedRing& operator=(const SharedRing&) = delete;
  ~SharedRing();

  /// Copies as many of the bytes as there is space for and returns how many.
  std::size_t put(std::span<const std::byte> bytes);
  /// Waits until the other end takes bytes, if there is no space.
  void wait_for_space();

  /// Copies as many bytes, which the other end has put. It reads nothing else that the other end
  /// can change, so a malicious one can only send other bytes.
  void take(std::span<std::byte> to);

 private:
  struct Shared;
  [[nodiscard]] std::uint32_t space() const;

  Shared* shared_;
  std::uint32_t at_ = 0;  ///< bytes that this end has put or taken, modulo 2^32
};

}  // namespace glidar
