// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace glidar::stereo {

/// Uninitialised memory in large pages where the system has them: half the time of a first match
/// would otherwise be spent on page faults.
class PageMemory {
 public:
  PageMemory() = default;
  ~PageMemory();
  PageMemory(PageMemory&& other) noexcept;
  PageMemory& operator=(PageMemory&& other) noexcept;
  PageMemory(const PageMemory&) = delete;
  PageMemory& operator=(const PageMemory&) = delete;

  /// Space for `count` elements; their values are unspecified afterwards. Throws std::bad_alloc.
  void reserve(std::size_t count);

  [[nodiscard]] std::int16_t* data() const { return data_; }

 private:
  void release() noexcept;

  std::int16_t* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace glidar::stereo
