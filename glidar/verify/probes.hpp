// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/verify/comparison.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>

namespace glidar {

/// Four uniform random numbers in (0, 1), a function of a case's number and an index.
std::array<double, 4> probe_uniforms(std::uint32_t number, std::uint32_t index);

/// A uniformly distributed rotation (Shoemake, "Uniform random rotations", Graphics Gems III).
Eigen::Quaterniond random_rotation(const std::array<double, 4>& u);

/// A unit direction, uniformly distributed within an angle of +z, from two uniform numbers.
Eigen::Vector3d random_direction(double u0, double u1, double half_angle_rad);

/// The beams of a small camera with this half field of view.
Beams camera_probes(double half_view_rad);

/// The beams of a spinning scanner: 32 rows with uneven elevations, staggered by up to a column,
/// and 1024 columns.
Beams scanner_probes();

/// Beams of one row without structure; empty origins: all zero.
Beams unstructured_probes(std::vector<Eigen::Vector3d> directions,
                          std::vector<Eigen::Vector3d> origins_m = {});

/// 4096 beams in random directions within an angle of +z, with origins in a square of width
/// spread_m around the sensor's. Uses probe_uniforms() 1 to 4096 of the case.
Beams random_probes(std::uint32_t number, double half_view_rad, double spread_m);

/// A shape that beams are aimed at, relative to the sensor's position.
struct AimTarget {
  const PlacedShape& placed;
  Eigen::Matrix3d sensor_from_axes;
  std::uint32_t number;  ///< key of the random numbers
};

/// Beams at all vertices and edges whose faces are all front-facing, and beams through the scaled
/// vertices, most of which miss the shape.
Beams beams_at_vertices_and_edges(const AimTarget& at);

/// Beams that pass the silhouette edges (between a front face and a back face) at a distance of
/// 1e-9 to 1e-6 of the shape's radius, on either side.
Beams beams_beside_outline(const AimTarget& at);

}  // namespace glidar
