// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <Eigen/Core>
#include <apps/glidar/options/cli_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// The poses of the sensor and the model; empty: not given.
struct PoseFlags {
  std::optional<Eigen::Vector3d> eye_m = {};
  std::optional<Eigen::Vector3d> target_m = {};
  std::optional<Eigen::Vector3d> up = {};
  std::optional<Pose> world_from_sensor = {};
  std::optional<Eigen::Quaterniond> model_q = {};   ///< by --model-q or --model-r
  std::optional<Eigen::Quaterniond> camera_q = {};  ///< by --camera-q or --camera-r
  std::optional<double> camera_z_m = {};
  std::optional<Eigen::Vector3d> scale = {};
};

void add_pose_options(CLI::App& command, PoseFlags& flags);

/// The pose options of the original GLIDAR. The other options of poses and motion come first: these
/// exclude some of them.
void add_woods2016_pose_options(CLI::App& command, PoseFlags& flags);

/// Where the stamps of frames come from, if the start of the run is not given.
enum class StampOrigin : std::uint8_t {
  outputs,  ///< a date if bags or packet captures are written, else zero
  zero,
  date,
  source,  ///< poses or requests state the stamps; trajectories keep their times
};

/// A time on the sensor's trajectory.
struct TrajectoryTime {
  std::int64_t t_ns = 0;
  bool is_after_first = false;  ///< counted from the first pose
};

/// How the sensor and the model move; empty: not given.
struct MotionFlags {
  std::optional<Eigen::Vector3d> object_rate_rad_s = {};
  std::optional<Eigen::Vector3d> sensor_rate_rad_s = {};
  std::string trajectory = {};
  std::optional<double> trajectory_rate_hz = {};
  std::string trajectory_times = {};
  Interpolation trajectory_interpolation = Interpolation::linear;
  std::optional<std::int64_t> start_time_ns = {};
  bool starts_now = false;  ///< at start_time_ns or now, whatever the times of the trajectory
  std::optional<TrajectoryTime> from = {};
  std::optional<TrajectoryTime> to = {};
  StampOrigin stamp_origin = StampOrigin::outputs;
};

/// The options of poses come first: some of them exclude these.
void add_motion_options(CLI::App& command, MotionFlags& flags);

/// The files that the flags name, which no output may replace.
std::vector<std::string> files_of(const MotionFlags& flags);

}  // namespace glidar::app
