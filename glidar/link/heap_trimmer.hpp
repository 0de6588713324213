// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>

namespace glidar::link {

/// Returns freed memory to the system after peers have left. The C library keeps it otherwise:
/// pieces of a message that was cut off are freed among others that stay, so that the heap remains
/// as large as all peers together have ever made it.
class HeapTrimmer {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPause{1};

  /// A peer has left; its memory is freed soon, in other threads.
  void expect() { checks_left_ = kChecks; }
  /// Whether check() is to be called again after kPause.
  [[nodiscard]] bool is_waiting() const { return checks_left_ > 0; }
  /// Returns the memory, at most once in kPause, if it is worth the time.
  void check(Clock::time_point now);

 private:
  static constexpr int kChecks = 3;

  int checks_left_ = 0;
  Clock::time_point last_;
};

}  // namespace glidar::link
