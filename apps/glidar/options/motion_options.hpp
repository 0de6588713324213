// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/motion/motion.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// How sensor and model move, as given; empty: not given.
struct MotionFlags {
  std::string model_dr = {};
  std::string camera_dr = {};
  std::string trajectory = {};
  std::optional<double> trajectory_rate_hz = {};
  std::string trajectory_times = {};
  std::optional<double> trajectory_start_s = {};
};

void add_motion_flags(CLI::App& command, MotionFlags& flags);

/// The sensor's trajectory by the flags: --trajectory, whose poses are world_from_sensor (optical
/// frame); or --sensor-rate from the pose at time 0; else `from_scene_file`; else standing still.
/// `pose_given`: an option says where the sensor is; it replaces the scene file's motion and
/// contradicts --trajectory (Error).
/// --sensor-rate turns about the axes of the 2015 program's sensor: x left, y up, z forward.
/// `optical_from_sensor` is the identity for a camera.
Trajectory sensor_trajectory(const MotionFlags& flags, const Pose& world_from_sensor,
                             const Pose& optical_from_sensor, bool pose_given,
                             const std::optional<Trajectory>& from_scene_file);

/// The instances' trajectories: the scene file's, or --object-rate about the single model's own
/// axes. Throws Error when the option is given and the scene has several objects or moves them
/// itself.
std::vector<Trajectory> instance_trajectories(const MotionFlags& flags, const Scene& scene,
                                              const std::vector<Trajectory>& from_scene_file);

/// The files that the flags name, which no output may replace.
std::vector<std::string> files_of(const MotionFlags& flags);

}  // namespace glidar::app
