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

/// Tells of faults that others may make in thousands: of each kind the first at once, then at most
/// one a second with how many there have been. May be used from any thread.
class FaultLog {
 public:
  using Clock = std::chrono::steady_clock;

  explicit FaultLog(Report report, std::function<Clock::time_point()> now = Clock::now);

  /// `kind` is counted, `what` is said: the latest of its kind.
  void tell(const std::string& kind, std::string_view what);
  /// Says what was held back; for the end.
  void flush();
  [[nodiscard]] std::map<std::string, std::uint64_t> counts() const;

 private:
  struct Kind {
    std::uint64_t count = 0;
    std::uint64_t told = 0;
    Clock::time_point last;
    std::string what;
  };
  void say(const std::string& name, Kind& kind) const;

  mutable std::mutex mutex_;
  Report report_;
  std::function<Clock::time_point()> now_;
  std::map<std::string, Kind> kinds_;
};

}  // namespace glidar::link
