// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/stream_report.hpp>

#include <glidar/math/portable.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

namespace {

constexpr double kMilli = 1e3;

}  // namespace

std::string status_text(const StreamStats& stats) {
  return fmt::format("{:.1f} Hz, latency {:.1f} ms (99 %: {:.1f} ms), {} frames",
                     stats.recent_rate_hz(), kMilli * stats.latency.quantile_s(0.5),
                     kMilli * stats.latency.quantile_s(0.99), stats.latency.count());
}

namespace {

nlohmann::ordered_json json_of(const woods2016::CloudPublisher::Counts& counts) {
  return {{"sent", counts.sent},     {"missed", counts.missed}, {"repeated", counts.repeated},
          {"points", counts.points}, {"bytes", counts.bytes},   {"handshakes", counts.handshakes}};
}

nlohmann::ordered_json json_of(const woods2016::PoseReceiver::Counts& counts) {
  return {{"received", counts.received},
          {"refused", counts.refused},
          {"repeated", counts.repeated},
          {"backwards", counts.backwards}};
}

std::string count_text(std::uint64_t count, const char* of) {
  return fmt::format("{} {}{}", count, of, count == 1 ? "" : "s");
}

}  // namespace

std::string json_text(const StreamSummary& summary) {
  const DurationHistogram& latency = summary.stats.latency;
  const double seconds = summary.stats.seconds();
  nlohmann::ordered_json all = {
      {"ending", summary.ending},
      {"seconds", seconds},
      {"frames",
       {{"measured", summary.measured}, {"delivered", latency.count()}, {"late", summary.late}}},
      {"rate_hz", static_cast<double>(latency.count()) / seconds},
      {"latency_ms",
       {{"p50", kMilli * latency.quantile_s(0.5)},
        {"p99", kMilli * latency.quantile_s(0.99)},
        {"max", kMilli * latency.max_s()}}}};
  if (summary.clouds) all["clouds"] = json_of(*summary.clouds);
  if (summary.poses) all["poses"] = json_of(*summary.poses);
  all["errors"] = summary.errors;
  constexpr int kIndent = 2;
  return all.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string summary_text(const StreamSummary& summary) {
  const DurationHistogram& latency = summary.stats.latency;
  std::string text =
      fmt::format("{} in {:.2f} s", count_text(latency.count(), "frame"), summary.stats.seconds());
  if (latency.count() > 0) {
    text += fmt::format(", {:.1f} Hz, latency {:.1f} ms (99 %: {:.1f} ms)",
                        static_cast<double>(latency.count()) / summary.stats.seconds(),
                        kMilli * latency.quantile_s(0.5), kMilli * latency.quantile_s(0.99));
  }
  if (summary.late > 0) text += fmt::format(", {} late", summary.late);
  if (summary.clouds) {
    text += fmt::format("\npublished {}, {} missed by a slow subscriber",
                        count_text(summary.clouds->sent, "cloud"), summary.clouds->missed);
  }
  if (summary.poses) {
    text += fmt::format("\nreceived {}, refused {}", count_text(summary.poses->received, "message"),
                        summary.poses->refused);
  }
  return text + "\nended: " + summary.ending + "\n";
}

std::string waiting_text(const StreamFlags& flags) {
  std::string text = "waiting for";
  if (flags.port && flags.subscribers > 0) {
    text += fmt::format(" {} (clouds at {}, handshakes at port {})",
                        count_text(flags.subscribers, "subscriber"),
                        text_of(link::Endpoint{flags.bind, *flags.port}), *flags.port + 1);
  }
  if (flags.pose_source) {
    text += fmt::format("{} a simulator (poses at {}, handshake at port {})",
                        flags.port && flags.subscribers > 0 ? " and" : "",
                        text_of(*flags.pose_source), flags.pose_source->port + 1);
  }
  return text;
}

std::string ready_text(std::uint64_t ready, std::uint64_t expected) {
  return fmt::format("{} of {} ready", ready, count_text(expected, "subscriber"));
}

std::string publishing_text(const woods2016::CloudPublisher::Counts& counts) {
  return fmt::format(", {}, {} missed", count_text(counts.subscribers, "subscriber"),
                     counts.missed);
}

}  // namespace glidar::app
