// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

namespace glidar::app {

/// An eye that orbits a point, with the world's +z up. Positions are relative to an anchor in the
/// world, so that single precision suffices for scenes far from the world's origin.
struct Orbit {
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();  ///< from the anchor
  double yaw_rad = 0.0;                               ///< of the eye about the pivot, from +x
  double pitch_rad = 0.5;                             ///< of the eye above the pivot
  double distance_m = 1.0;
};

inline constexpr double kOrbitFov_rad = 0.8;  ///< vertical

/// Rotates by a drag in window heights, right and down.
void turn(Orbit& orbit, const Eigen::Vector2d& drag);
/// Moves the pivot with the drag, so that it stays under the pointer.
void pan(Orbit& orbit, const Eigen::Vector2d& drag);
/// Moves closer by steps of 10 %.
void zoom(Orbit& orbit, double steps);

/// The eye in the optical frame (x right, y down, z forward), from the anchor.
Pose anchor_from_eye(const Orbit& orbit);

/// OpenGL's matrix for points relative to the anchor; aspect is width / height.
Eigen::Matrix4f clip_from_anchor(const Orbit& orbit, double aspect);

/// The point closest to the eye among those displayed within `reach` heights of a position. Points
/// are relative to the anchor. The position is from -aspect to aspect (right) and -1 to 1 (up).
std::optional<std::size_t> point_at(const Orbit& orbit, std::span<const Eigen::Vector3f> points,
                                    const Eigen::Vector2d& place, double reach);

}  // namespace glidar::app
