// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/run_clock.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/time_text.hpp>

#include <algorithm>
#include <string>
#include <variant>

namespace glidar {
namespace {

bool has_timed_poses(const Trajectory& trajectory) {
  return valid_interval(trajectory).first_ns != TimeInterval{}.first_ns;
}

/// The time from which a motion counts; that of the first pose of timed poses.
struct FirstTime {
  std::int64_t operator()(const ConstantPose& /*constant*/) const { return 0; }
  std::int64_t operator()(const ConstantTwist& twist) const { return twist.t0_ns; }
  std::int64_t operator()(const Spin& spin) const { return spin.t0_ns; }
  std::int64_t operator()(const TimedPoses& timed) const { return timed.first_ns(); }
  std::int64_t operator()(const TorqueFreeRotation& free) const { return free.start().t0_ns; }
  std::int64_t operator()(const Mounted& mounted) const {
    return std::visit(*this, mounted.carrier);
  }
};

/// Own times of the trajectories when the run starts.
struct OwnTimes {
  std::int64_t dated_ns = 0;
  std::int64_t undated_ns = 0;
};

void set_clock(const OwnTimes& own, std::int64_t start_ns, Trajectory& trajectory) {
  const bool has_date = is_date(std::visit(FirstTime(), trajectory));
  const std::int64_t from_ns = has_date ? own.dated_ns : own.undated_ns;
  if (from_ns != start_ns) trajectory = retimed(trajectory, from_ns, start_ns);
}

/// Where on the sensor's trajectory the run starts.
std::int64_t start_on(const Trajectory& sensor, const RunStart& run) {
  const TimeInterval known = valid_interval(sensor);
  const bool is_at_date = run.time_ns && !run.moves_trajectory && is_date(known.first_ns);
  const std::int64_t at_ns = run.from_ns.value_or(is_at_date ? *run.time_ns : known.first_ns);
  if (at_ns >= known.first_ns && at_ns <= known.last_ns) return at_ns;
  throw Error({run.from_ns ? "start on the trajectory" : "start time",
               decimal_seconds(at_ns) + " s, outside of the trajectory of the sensor",
               decimal_seconds(known.first_ns) + " to " + decimal_seconds(known.last_ns) + " s",
               run.from_ns ? "times are those of the trajectory"
                           : "state also where on the trajectory the run starts then (--from " +
                                 decimal_seconds(known.first_ns) + " for example)"});
}

/// The first of the dates of objects.
std::optional<std::int64_t> first_date(const std::vector<Trajectory>& trajectories) {
  std::optional<std::int64_t> first;
  for (const Trajectory& trajectory : trajectories) {
    const std::int64_t t_ns = std::visit(FirstTime(), trajectory);
    if (is_date(t_ns)) first = std::min(first.value_or(t_ns), t_ns);
  }
  return first;
}

}  // namespace

std::int64_t set_run_clock(const RunStart& run, Trajectory& world_from_sensor,
                           std::vector<Trajectory>& world_from_instance) {
  OwnTimes own;
  std::optional<std::int64_t> date = first_date(world_from_instance);
  if (run.time_ns && !run.moves_trajectory) date = run.time_ns;
  if (has_timed_poses(world_from_sensor)) {
    const std::int64_t at_ns = start_on(world_from_sensor, run);
    if (is_date(valid_interval(world_from_sensor).first_ns)) {
      date = at_ns;
    } else {
      own.undated_ns = at_ns;
    }
  } else if (run.from_ns) {
    throw Error({"start on the trajectory", "the sensor has none", "a file of timed poses",
                 "leave it out, or give a trajectory"});
  }
  own.dated_ns = date.value_or(0);
  const std::int64_t start_ns = run.time_ns.value_or(date ? *date : run.origin_ns + own.undated_ns);
  set_clock(own, start_ns, world_from_sensor);
  for (Trajectory& trajectory : world_from_instance) set_clock(own, start_ns, trajectory);
  return start_ns;
}

}  // namespace glidar
