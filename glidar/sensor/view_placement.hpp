// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>

namespace glidar {

/// How much of the image's half width or height fit_camera_to_scene leaves free on each side.
inline constexpr double kFramingMargin = 0.05;

/// The nearest pose (world_from_sensor) of a camera outside the box around the scene from which
/// every vertex lies in its image, with kFramingMargin left free; more is left free where so wide a
/// view would fill only from within the box. The camera stands on the side `from_direction` (world,
/// from the scene to the camera, any length) and looks the other way; `up` (world) points up in the
/// image. It is shifted sideways so that the scene stands in the middle, wherever the principal
/// point is.
/// The image is the rectangle of its pixels; with distorted optics the largest upright rectangle
/// that the outermost beams enclose, or, when these look backwards or are missing (fisheye), the
/// cone about the middle beam that they enclose.
/// Throws Error when the scene has no triangles or no size, when the beams are not those of a
/// camera (boresight +z, an image with an area), and where look_at does.
Pose fit_camera_to_scene(const Beams& beams, const Scene& scene,
                         const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up);

/// The pose of a LiDAR (boresight +x) that stands upright beside the scene, heading for its middle:
/// on the side `from_direction` (what is left of it along `up` does not count), so far away that
/// the sphere about the scene's box lies between its lowest and highest beams, its middle at the
/// middle elevation. A scanner of one line stands at twice the sphere's radius.
/// Throws Error when the scene has no size, the beams are not those of a LiDAR, or from_direction
/// is parallel to `up`.
Pose place_lidar_beside(const Beams& beams, const Scene& scene,
                        const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up);

}  // namespace glidar
