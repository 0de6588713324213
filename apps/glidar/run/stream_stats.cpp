// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stream_stats.hpp>

#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

double seconds_between(StreamStats::Clock::time_point from, StreamStats::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

constexpr double kWindow_s = 1.0;

}  // namespace

void DurationHistogram::add(double seconds) {
  const double position = kBinsPerFactorE * portable_log(std::max(seconds, kMin_s) / kMin_s);
  ++bins_.at(std::min(static_cast<std::size_t>(position), kBins - 1));
  ++count_;
  max_s_ = std::max(max_s_, seconds);
}

double DurationHistogram::quantile_s(double part) const {
  const double wanted = std::ceil(part * static_cast<double>(count_));
  double seen = 0.0;
  for (std::size_t i = 0; i < kBins && count_ > 0; ++i) {
    seen += static_cast<double>(bins_.at(i));
    if (seen < wanted || seen == 0.0) continue;
    const double end_s = kMin_s * portable_exp(static_cast<double>(i + 1) / kBinsPerFactorE);
    return std::min(end_s, max_s_);
  }
  return max_s_;
}

void StreamStats::add_frame(Clock::time_point due) {
  const Clock::time_point now = Clock::now();
  latency.add(seconds_between(due, now));
  last_ = now;
  ++window_count_;
  const double window_s = seconds_between(window_start_, now);
  if (window_s < kWindow_s) return;
  recent_rate_hz_ = static_cast<double>(window_count_) / window_s;
  window_start_ = now;
  window_count_ = 0;
}

double StreamStats::seconds() const {
  return seconds_between(start, latency.count() > 0 ? last_ : Clock::now());
}

double StreamStats::recent_rate_hz() const {
  const double window_s = seconds_between(window_start_, Clock::now());
  if (window_s < kWindow_s && recent_rate_hz_ > 0.0) return recent_rate_hz_;
  return static_cast<double>(window_count_) / window_s;  // at the start, and when frames stop
}

std::string status_text(const StreamStats& stats) {
  constexpr double kMilli = 1e3;
  return fmt::format("{:.1f} Hz, latency {:.1f} ms (99 %: {:.1f} ms), {} frames",
                     stats.recent_rate_hz(), kMilli * stats.latency.quantile_s(0.5),
                     kMilli * stats.latency.quantile_s(0.99), stats.latency.count());
}

}  // namespace glidar::app
