// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

namespace glidar::app {

/// An eye that goes round a point, with the world's +z upwards. Lengths are relative to an anchor
/// in the world, so that single precision serves scenes far from the world's zero.
struct Orbit {
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();  ///< from the anchor
  double yaw_rad = 0.0;                               ///< of the eye about the pivot, from +x
  double pitch_rad = 0.5;                             ///< of the eye above the pivot
  double distance_m = 1.0;
};

inline constexpr double kOrbitFov_rad = 0.8;  ///< upright

/// By a drag of so many window heights: to the right and down.
void turn(Orbit& orbit, const Eigen::Vector2d& drag);
/// Moves the pivot with the drag, so that it stays under the pointer.
void pan(Orbit& orbit, const Eigen::Vector2d& drag);
/// Nearer by steps of a tenth.
void zoom(Orbit& orbit, double steps);

/// The eye in the optical frame (x right, y down, z forward), from the anchor.
Pose anchor_from_eye(const Orbit& orbit);

/// OpenGL's matrix for points relative to the anchor; aspect is width / height.
Eigen::Matrix4f clip_from_anchor(const Orbit& orbit, double aspect);

/// Of the points relative to the anchor that are seen within `reach` heights of a place, the
/// nearest to the eye. The place runs from -aspect to aspect (right) and -1 to 1 (up).
std::optional<std::size_t> point_at(const Orbit& orbit, std::span<const Eigen::Vector3f> points,
                                    const Eigen::Vector2d& place, double reach);

}  // namespace glidar::app
