// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/motion/pose_block.hpp>

#include <cstdint>
#include <span>

namespace glidar {

/// A sensor that moves during a frame.
struct MovingSensor {
  const Trajectory& world_from_sensor;
  const Pose& at_start;  ///< at stamp_ns
  std::int64_t stamp_ns = 0;
};

/// The poses of the sensor at the firing times of beams, at most PoseBlock::kSize, relative to its
/// pose at the start: S0^-1 * S. Positions are subtracted first, for full precision far from
/// the world's origin.
void find_start_from_sensor(const MovingSensor& sensor, const Beams& beams, BeamRange range,
                            PoseBlock& start_from_sensor);

/// Rotates directions by one pose each, and normalises them.
void rotate_directions(const PoseBlock& poses, std::span<const Eigen::Vector3d> directions,
                       std::span<Eigen::Vector3d> rotated);

/// Transforms origins by one pose each; empty `origins_m`: all zero.
void transform_origins(const PoseBlock& poses, std::span<const Eigen::Vector3d> origins_m,
                       std::span<Eigen::Vector3d> transformed_m);

}  // namespace glidar
