// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
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

struct Sphere {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// The sphere about the mean of the corners that contains them all; zero without corners.
Sphere sphere_around(std::span<const Eigen::Vector3d> corners_m);

/// Moves the eye so that the whole sphere is visible; the view direction stays. `aspect` is
/// width / height.
void frame_sphere(Orbit& orbit, const Sphere& anchored, double aspect);

/// Moves the eye away from its pivot until all points, relative to the anchor, are visible.
void zoom_out_to(Orbit& orbit, std::span<const Eigen::Vector3d> points, double aspect);

/// A view with the box, which may be empty, and the sensor in it. Both are relative to the anchor,
/// which is the middle of the box.
Orbit view_of_all(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& sensor_m, double aspect);

/// The field of view of a sensor: tangents of the angles from the boresight to its edges.
struct FieldOfView {
  SensorAxes axes;
  double left = 0.0;  ///< > 0
  double right = 0.0;
  double up = 0.0;
  double down = 0.0;
};

/// Empty for sensors that cannot be aimed: 360 degree scanners, lines, single beams.
std::optional<FieldOfView> field_of_view(const Beams& beams);

/// How much of an object is in the image, regardless of occlusion.
enum class Visibility : std::uint8_t { inside, partly, outside };

/// For the convex hull of the corners (world). `outside` is certain: all corners are behind
/// the sensor or beyond one edge of the image.
Visibility visibility(const FieldOfView& field, const Pose& world_from_sensor,
                      std::span<const Eigen::Vector3d> corners_m);

/// The sensor's pose after the smallest rotation that points the boresight at the point. Empty: the
/// sensor is at the point.
std::optional<Pose> aimed_at(const FieldOfView& field, const Pose& world_from_sensor,
                             const Eigen::Vector3d& point_m);

/// A pose of the sensor with all corners in its image: aimed at their centre, then moved back if
/// they do not fit. Empty: no change needed, or the sensor is between them.
std::optional<Pose> pose_to_show(const FieldOfView& field, const Pose& world_from_sensor,
                                 std::span<const Eigen::Vector3d> corners_m);

}  // namespace glidar::app
