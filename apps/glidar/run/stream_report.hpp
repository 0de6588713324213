// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/stream_options.hpp>
#include <glidar/woods2016/protocol.hpp>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace glidar::app {

/// A histogram of durations in bins of 2 %, with constant memory.
class DurationHistogram {
 public:
  void add(double seconds);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// A quantile, to 2 %; 0 without durations.
  [[nodiscard]] double quantile_s(double part) const;
  [[nodiscard]] double max_s() const { return max_s_; }

 private:
  static constexpr double kMin_s = 1e-6;
  static constexpr double kBinsPerFactorE = 50.0;
  static constexpr std::size_t kBins = 1100;  // to an hour

  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double max_s_ = 0.0;
};

/// Statistics of delivered frames; used by the delivering thread.
struct StreamStats {
  using Clock = std::chrono::steady_clock;

  Clock::time_point start = Clock::now();
  DurationHistogram latency;  ///< from a frame's pose to its delivery

  /// Counts a delivered frame.
  void add_frame(Clock::time_point due);
  /// From the start to the last frame; without frames, to now.
  [[nodiscard]] double seconds() const;
  /// Frames per second, over about the last second, else over all.
  [[nodiscard]] double recent_rate_hz() const;

 private:
  Clock::time_point last_ = start;
  Clock::time_point window_start_ = start;
  std::uint64_t window_count_ = 0;
  double recent_rate_hz_ = 0.0;
};

/// "25.0 Hz, latency 3.1 ms (99 %: 5.0 ms), 120 frames".
std::string status_text(const StreamStats& stats);

/// The result of a stream.
struct StreamSummary {
  const StreamStats& stats;
  std::string ending;
  std::uint64_t measured = 0;  ///< frames
  std::uint64_t late = 0;      ///< frames after their due time
  std::optional<woods2016::CloudPublisher::Counts> clouds = {};
  std::optional<woods2016::PoseReceiver::Counts> poses = {};
  std::map<std::string, std::uint64_t> errors = {};
};

/// The JSON of --stats; docs/link.md describes every key.
std::string json_text(const StreamSummary& summary);

/// The summary that is printed at the end.
std::string summary_text(const StreamSummary& summary);

/// The message while the stream waits for peers.
std::string waiting_text(const StreamFlags& flags);

/// How many of the awaited subscribers will receive the next cloud.
std::string ready_text(std::uint64_t ready, std::uint64_t expected);

/// The part of the status line about subscribers.
std::string publishing_text(const woods2016::CloudPublisher::Counts& counts);

}  // namespace glidar::app
