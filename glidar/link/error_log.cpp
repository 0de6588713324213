// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/error_log.hpp>

#include <glidar/core/text.hpp>

#include <utility>

namespace glidar::link {
namespace {

constexpr std::chrono::seconds kPause{1};
constexpr std::size_t kMaxText_bytes = 1000;

}  // namespace

ErrorLog::ErrorLog(Report report, std::function<Clock::time_point()> now)
    : report_(std::move(report)), now_(std::move(now)) {}

void ErrorLog::report(const std::string& kind, std::string_view what) {
  const std::lock_guard lock(mutex_);
  Kind& known = kinds_[kind];
  ++known.count;
  known.what = excerpt(what, kMaxText_bytes);
  const Clock::time_point now = now_();
  if (known.count > 1 && now - known.last < kPause) return;
  known.last = now;
  print(kind, known);
}

void ErrorLog::flush() {
  const std::lock_guard lock(mutex_);
  for (auto& [name, kind] : kinds_) {
    if (kind.reported < kind.count) print(name, kind);
  }
}

std::map<std::string, std::uint64_t> ErrorLog::counts() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [name, kind] : kinds_) counts[name] = kind.count;
  return counts;
}

void ErrorLog::print(const std::string& name, Kind& kind) const {
  kind.reported = kind.count;
  std::string text = name;
  if (kind.count > 1) text += " (" + std::to_string(kind.count) + " times)";
  report_.warn(text + ": " + kind.what);
}

}  // namespace glidar::link
