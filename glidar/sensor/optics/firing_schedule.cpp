// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/firing_schedule.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/portable.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace glidar {
namespace {

constexpr std::int64_t kLongest_ns = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t kMaxTime_ns = 100LL * 24 * 3600 * 1'000'000'000;  // a double holds each ns

void check(const FrameInterval& interval) {
  const std::int64_t length_ns = interval.end_ns - interval.start_ns;
  if (length_ns >= 0 && length_ns <= kLongest_ns && std::abs(interval.start_ns) <= kMaxTime_ns) {
    return;
  }
  throw Error({.where = "scan interval",
               .found = std::to_string(interval.start_ns) + " to " +
                        std::to_string(interval.end_ns) + " ns",
               .allowed = "up to 4.29 s long, within 100 days of zero",
               .remedy = "choose a frame rate of at least 0.24 Hz"});
}

/// The first tick at or after a time.
std::int64_t first_from(const FiringSchedule& schedule, std::int64_t time_ns) {
  auto k = static_cast<std::int64_t>(
      std::floor((static_cast<double>(time_ns) - schedule.first_ns) / schedule.period_ns));
  while (firing_time_ns(schedule, k - 1) >= time_ns) --k;  // the division is rounded
  while (firing_time_ns(schedule, k) < time_ns) ++k;
  return k;
}

}  // namespace

std::int64_t firing_time_ns(const FiringSchedule& schedule, std::int64_t k) {
  return std::llround(schedule.first_ns + static_cast<double>(k) * schedule.period_ns);
}

FiringRange firings_in(const FiringSchedule& schedule, const FrameInterval& interval,
                       std::size_t max) {
  check(interval);
  constexpr double kMinPeriod_ns = 1.0;
  constexpr double kMax_ns = static_cast<double>(kMaxTime_ns);
  require_number(schedule.period_ns >= kMinPeriod_ns && schedule.period_ns <= kMax_ns,
                 "optics, period", schedule.period_ns, "ns from 1 to 8.64e15, 100 days");
  require_number(std::abs(schedule.first_ns) <= kMax_ns, "optics, first time", schedule.first_ns,
                 "ns within 8.64e15, 100 days, of zero");
  const FiringRange range = {first_from(schedule, interval.start_ns),
                             first_from(schedule, interval.end_ns)};
  require_number(range.size() <= max, "optics, firings in a frame",
                 static_cast<double>(range.size()), "134217728 beams in all");
  return range;
}

Eigen::Vector3d direction_at(double azimuth_rad, double elevation_rad) {
  const SineCosine up = portable_sincos(elevation_rad);
  const SineCosine around = portable_sincos(azimuth_rad);
  return {up.cosine * around.cosine, up.cosine * around.sine, up.sine};
}

}  // namespace glidar
