// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/ray_table.hpp>

#include <algorithm>
#include <cmath>
#include <glidar/core/error.hpp>

namespace glidar {
namespace {

/// Entry `index` of the table, fired `time_ns` after the start of the interval.
struct Firing {
  std::size_t index;
  std::uint32_t time_ns;
};

void require_size(std::size_t found, std::size_t size, bool may_be_empty, const char* where) {
  require_number(found == size || (may_be_empty && found == 0), where, static_cast<double>(found),
                 "one entry per beam (rows x cols)");
}

void check_times(const RayTable& table) {
  const std::vector<double>& times = table.times_ns;
  if (times.empty()) return;
  require_number(std::is_sorted(times.begin(), times.end()), "optics, times", times.front(),
                 "times in increasing order");
  // Half a nanosecond less: times are rounded to nanoseconds and must stay in their own period.
  require_number(times.front() >= 0.0 && times.back() <= table.period_ns - 0.5, "optics, times",
                 times.back(), "from 0 to half a nanosecond before the period's end");
}

void validate(const RayTable& table) {
  const std::size_t size = std::size_t{table.rows} * table.cols;
  require_number(size >= 1 && size <= kMaxBeams, "optics, number of beams",
                 static_cast<double>(size), "1 to 134217728");
  require_size(table.directions.size(), size, false, "optics, directions");
  require_size(table.origins_m.size(), size, true, "optics, origins");
  require_size(table.times_ns.size(), size, true, "optics, times");
  require_size(table.rings.size(), size, true, "optics, rings");
  for (const Eigen::Vector3d& d : table.directions) {
    require_number(std::isnan(d.x()) || (d.allFinite() && d.norm() > 0.0), "optics, directions",
                   d.norm(), "vectors of finite length above 0, or NaN");
  }
  check_times(table);
}

/// The firings of the periods that touch the interval, less those outside it.
std::vector<Firing> table_firings(const RayTable& table, const FrameInterval& interval) {
  const FiringSchedule last = {table.times_ns.back(), table.period_ns};
  const FiringRange periods = firings_in(last, interval, kMaxBeams / table.times_ns.size());
  std::vector<Firing> firings;
  firings.reserve((periods.size() + 1) * table.times_ns.size());
  for (std::int64_t period = periods.begin; period <= periods.end; ++period) {
    for (std::size_t i = 0; i < table.times_ns.size(); ++i) {
      const std::int64_t time_ns = firing_time_ns({table.times_ns[i], table.period_ns}, period);
      if (time_ns < interval.start_ns || time_ns >= interval.end_ns) continue;
      firings.push_back({i, static_cast<std::uint32_t>(time_ns - interval.start_ns)});
    }
  }
  return firings;
}

bool is_one_period(const RayTable& table, const std::vector<Firing>& firings) {
  return firings.size() == table.times_ns.size() && !firings.empty() && firings.front().index == 0;
}

std::vector<Firing> all_at_once(std::size_t size) {
  std::vector<Firing> firings(size);
  for (std::size_t i = 0; i < size; ++i) firings[i] = {i, 0};
  return firings;
}

}  // namespace

Beams make_beams(const RayTable& table, const FrameInterval& interval) {
  validate(table);
  const bool timed = !table.times_ns.empty();
  const std::vector<Firing> firings =
      timed ? table_firings(table, interval) : all_at_once(table.directions.size());
  const bool grid = !timed || is_one_period(table, firings);
  Beams beams;
  beams.rows = grid ? table.rows : 1;
  beams.cols = grid ? table.cols : static_cast<std::uint32_t>(firings.size());
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  for (const Firing& firing : firings) {
    beams.directions.push_back(table.directions[firing.index].normalized());
    if (timed) beams.times_ns.push_back(firing.time_ns);
    if (!table.origins_m.empty()) beams.origins_m.push_back(table.origins_m[firing.index]);
    beams.rings.push_back(table.rings.empty()
                              ? static_cast<std::uint16_t>(firing.index / table.cols)
                              : table.rings[firing.index]);
  }
  return beams;
}

}  // namespace glidar
