// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace glidar {

/// Times from the start of GPS time on, 1980-01-06, are dates: nanoseconds since 1970. Earlier ones
/// count from an origin of their own.
inline constexpr std::int64_t kFirstDate_ns = 315'964'800'000'000'000;

/// The origin of such times in outputs that need dates: 2026-01-01T00:00:00Z.
inline constexpr std::int64_t kDefaultDate_ns = 1'767'225'600'000'000'000;

inline bool is_date(std::int64_t t_ns) {
  return t_ns >= kFirstDate_ns;
}

/// When a run starts. Its first frame has the time of the start, and all stamps follow from it.
struct RunStart {
  /// The start; empty: the time of the trajectory, counted from the origin if it is not a date.
  std::optional<std::int64_t> time_ns = {};
  /// Where on the sensor's trajectory the run starts, in the times of the trajectory; empty: at its
  /// first pose, or at `time_ns` if it has dates.
  std::optional<std::int64_t> from_ns = {};
  std::int64_t origin_ns = 0;     ///< of times that are not dates
  bool moves_trajectory = false;  ///< `time_ns` may be outside of a trajectory with dates
};

/// Shifts trajectories from their own times to those of the stamps, and returns the start of the
/// run. Trajectories with dates share one clock, and so do all others, motions without timed poses
/// among them. The clock of the sensor's trajectory is such that the run starts at `from_ns`. The
/// other clock starts with the run if it has no dates. If only objects have dates, the run starts
/// at the first of their times unless `time_ns` is given, to which their times then refer. Throws
/// Error if the start is outside of the sensor's trajectory, or the sensor has no timed poses but
/// `from_ns` is given.
std::int64_t set_run_clock(const RunStart& run, Trajectory& world_from_sensor,
                           std::vector<Trajectory>& world_from_instance);

}  // namespace glidar
