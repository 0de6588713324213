// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/core/pose.hpp>

#include <optional>

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

}  // namespace glidar::app
