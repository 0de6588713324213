// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>

namespace glidar {

/// The pose of an upright LiDAR (boresight +x) beside the scene, facing its centre: in the
/// direction `from_direction` (without its component along `up`), at the distance where the
/// bounding sphere of the scene's box is between the lowest and highest beams, its centre at the
/// middle elevation. For a scanner of one line the distance is twice the sphere's radius. Throws
/// Error if the scene has no extent, the beams are not those of a LiDAR, or from_direction is
/// parallel to `up`.
Pose place_lidar_beside(const Beams& beams, const Scene& scene,
                        const Eigen::Vector3d& from_direction, const Eigen::Vector3d& up);

}  // namespace glidar
