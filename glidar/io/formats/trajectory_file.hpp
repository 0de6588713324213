// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/timed_poses.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>

namespace glidar {

/// Data that a trajectory file lacks.
struct TrajectoryFileOptions {
  std::optional<double> rate_hz = {};     ///< KITTI: poses per second, the first at 0
  std::filesystem::path times_file = {};  ///< KITTI: a file with one time per line, s; empty: none
  std::optional<std::int64_t> start_ns = {};  ///< shifts all times so that the first is this
};

/// Reads timed poses. The first row determines the format (docs/files/motion.md): 8 numbers are TUM
/// (t x y z qx qy qz qw), 12 are KITTI (three rows of a matrix), names with commas are CSV.
/// Every error states file:line:column, what was found and what is allowed.
TimedPoses load_trajectory_file(const std::filesystem::path& path,
                                const TrajectoryFileOptions& options = {});

}  // namespace glidar
