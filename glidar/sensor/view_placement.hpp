// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>

namespace glidar {

/// Share of the image's half width and half height that fit_camera_to_scene() leaves free on each
/// side.
inline constexpr double kFramingMargin = 0.05;

/// The nearest world_from_sensor of a camera outside the scene's bounding box whose image contains
/// every vertex, with the margin kFramingMargin. The margin is larger where a wide view would fill
/// the image only from inside the box. The camera is in the direction `from_direction` (world, from
/// the scene to the camera, any length) and faces the opposite way; `up` (world) is up in the
/// image. It is shifted sideways so that the scene is centred, wherever the principal point is. The
/// image is the rectangle of the pixels. With distortion it is the largest upright rectangle inside
/// the outermost beams, or, if these face backwards or are missing (fisheye), the cone about the
/// middle beam that they enclose. Throws Error if the scene has no triangles or no extent, if the
/// beams are not those of a camera (boresight +z, an image with an area), and as look_at() does.
Pose fit_camera_to_scene(const Beams& beams, const Scene& scene,
                         const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up);

/// The pose of an upright LiDAR (boresight +x) beside the scene, facing its centre: in the
/// direction `from_direction` (without its component along `up`), at the distance where the
/// bounding sphere of the scene's box is between the lowest and highest beams, its centre at the
/// middle elevation. For a scanner of one line the distance is twice the sphere's radius. Throws
/// Error if the scene has no extent, the beams are not those of a LiDAR, or from_direction is
/// parallel to `up`.
Pose place_lidar_beside(const Beams& beams, const Scene& scene,
                        const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up);

}  // namespace glidar
