// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/bake_mesh.hpp>
#include <import/scene_walk.hpp>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace glidar::import {

/// Counts of vertices, triangles and normals that were left out or recomputed, over all parts.
struct Repairs {
  std::uint64_t not_finite = 0;  ///< triangles
  std::uint64_t bad_normals = 0;
  std::uint64_t unused_vertices = 0;
};

/// The file's material of a placed mesh.
std::size_t material_of(const Placed& placed);

/// Visits the vertices of triangles, in the model's frame. Skips triangles with vertices outside
/// the range of single precision.
void for_used_vertices(const Placed& placed,
                       const std::function<void(const Eigen::Vector3d&)>& visit);

/// One placed mesh in the model's frame, relative to `origin`, vertices merged and its normals (and
/// tangents, if needed) there.
Mesh make_part(const Placed& placed, const Eigen::Vector3d& origin, const BakeOptions& options,
               const SlotNeeds& needs, Repairs& repairs);

}  // namespace glidar::import
