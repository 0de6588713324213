// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/motion/timed_poses.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Data that a trajectory file lacks.
struct TrajectoryFileOptions {
  std::optional<double> rate_hz = {};     ///< KITTI: poses per second, the first at 0
  std::filesystem::path times_file = {};  ///< KITTI: a file with one time per line, s; empty: none
  std::optional<std::int64_t> start_ns = {};  ///< shifts all times so that the first is this
  /// Bags: the topic, and the pose of child_frame in parent_frame. Empty: `/tf`, else a topic of
  /// odometry or poses, and the first pair of frames that moves.
  std::string topic = {};
  std::string parent_frame = {};
  std::string child_frame = {};
  Interpolation interpolation = Interpolation::linear;
};

/// Reads timed poses. The first row determines the format (docs/files/motion.md): 8 numbers are TUM
/// (t x y z qx qy qz qw), 12 are KITTI (three rows of a matrix), names with commas are CSV or
/// EuRoC. Paths that end in .mcap, .bag or .rosbag2, and folders with metadata.yaml, are bags
/// (docs/bags.md). Every error states file:line:column, what was found and what is allowed.
TimedPoses load_trajectory_file(const std::filesystem::path& path,
                                const TrajectoryFileOptions& options = {});

/// Reads poses without times, one in each row: x y z, x y z yaw_deg, x y z qx qy qz qw, or 12
/// numbers (three rows of a matrix), with blanks or commas between; a row of these names may be
/// first.
std::vector<Pose> load_poses(const std::filesystem::path& path);

}  // namespace glidar
