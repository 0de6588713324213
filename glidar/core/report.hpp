// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string_view>

namespace glidar {

/// Progress callback, fraction in [0, 1]; empty: no reporting. Called from worker threads, one call
/// at a time.
using ProgressCallback = std::function<void(double fraction_done)>;

/// Maps the progress of a part to [begin, end] of `whole`, which must outlive the result.
ProgressCallback subrange(const ProgressCallback& whole, double begin, double end);

enum class Severity { info, warning };

/// Callbacks for messages and progress, because the library prints nothing. Empty functions report
/// nothing. `log` gets one printable line, whatever the message contains, see printable_line().
/// `progress` may be called from worker threads, one call at a time; a negative fraction
/// means unknown.
struct Report {
  std::function<void(Severity, std::string_view message)> log;
  std::function<void(std::string_view task, double fraction_done)> progress;

  void info(std::string_view message) const;
  void warn(std::string_view message) const;
};

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
