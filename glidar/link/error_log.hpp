// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace glidar::link {

/// Logs errors that peers may cause in large numbers: the first of each kind at once, later ones at
/// most once per second with their count. Thread-safe.
class ErrorLog {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ErrorLog(Report report, std::function<Clock::time_point()> now = Clock::now);

  /// Counts an error of this kind; `what` is its message, of which only the latest is logged.
  void report(const std::string& kind, std::string_view what);
  /// Logs the errors that report() has delayed.
  void flush();
  [[nodiscard]] std::map<std::string, std::uint64_t> counts() const;

 private:
  struct Kind {
    std::uint64_t count = 0;
    std::uint64_t reported = 0;
    Clock::time_point last;
    std::string what;
  };
  void print(const std::string& name, Kind& kind) const;

  mutable std::mutex mutex_;
  Report report_;
  std::function<Clock::time_point()> now_;
  std::map<std::string, Kind> kinds_;
};

}  // namespace glidar::link
