// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>

#include <atomic>
#include <cstddef>

namespace glidar {

/// Counts the pieces of a loop that many threads share, and reports them to a ProgressCallback: at
/// most kSteps times, never two at once, never backwards. Where nobody asks it costs a branch.
class ProgressCounter {
 public:
  ProgressCounter(const ProgressCallback& progress, std::size_t pieces)
      : progress_(progress), all_(pieces) {}

  /// These many more are done.
  void add(std::size_t pieces) {
    if (!progress_) return;
    const std::size_t before = done_.fetch_add(pieces, std::memory_order_relaxed);
    if (step(before) == step(before + pieces)) return;
    if (telling_.test_and_set(std::memory_order_acquire)) return;  // the next step will tell
    progress_(part(done_.load(std::memory_order_relaxed)));
    telling_.clear(std::memory_order_release);
  }

  /// Tells that all is done; a step that came while another was told may have been left out.
  void finish() const {
    if (progress_) progress_(1.0);
  }

 private:
  static constexpr std::size_t kSteps = 1000;

  [[nodiscard]] double part(std::size_t done) const {
    return static_cast<double>(done) / static_cast<double>(all_);
  }
  [[nodiscard]] std::size_t step(std::size_t done) const {
    return static_cast<std::size_t>(static_cast<double>(kSteps) * part(done));
  }

  const ProgressCallback& progress_;
  std::size_t all_;
  std::atomic<std::size_t> done_{0};
  std::atomic_flag telling_;
};

}  // namespace glidar
