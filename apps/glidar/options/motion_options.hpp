// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// How the sensor and the model move; empty: not given.
struct MotionFlags {
  std::optional<Eigen::Vector3d> object_rate_rad_s = {};
  std::optional<Eigen::Vector3d> sensor_rate_rad_s = {};
  std::string trajectory = {};
  std::optional<double> trajectory_rate_hz = {};
  std::string trajectory_times = {};
  std::optional<std::int64_t> trajectory_start_ns = {};
  Interpolation trajectory_interpolation = Interpolation::linear;
};

/// The options of poses come first: some of them exclude these.
void add_motion_options(CLI::App& command, MotionFlags& flags);

/// The files that the flags name, which no output may replace.
std::vector<std::string> files_of(const MotionFlags& flags);

}  // namespace glidar::app
