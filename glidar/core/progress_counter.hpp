// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>

#include <atomic>
#include <chrono>
#include <cstddef>

namespace glidar {

/// Seconds from `start` to now.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Counts the finished pieces of a parallel loop and reports them to a ProgressCallback: at most
/// kSteps times, one call at a time, with increasing fractions. Without a callback it costs a
/// branch.
class ProgressCounter {
 public:
  ProgressCounter(const ProgressCallback& progress, std::size_t pieces)
      : progress_(progress), all_(pieces) {}

  /// Adds finished pieces.
  void add(std::size_t pieces) {
    if (!progress_) return;
    const std::size_t before = done_.fetch_add(pieces, std::memory_order_relaxed);
    if (step(before) == step(before + pieces)) return;
    if (reporting_.test_and_set(std::memory_order_acquire)) return;  // a later step reports it
    progress_(part(done_.load(std::memory_order_relaxed)));
    reporting_.clear(std::memory_order_release);
  }

  /// Reports 1; add() may have skipped the last step while another thread reported.
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
  std::atomic_flag reporting_;
};

}  // namespace glidar
