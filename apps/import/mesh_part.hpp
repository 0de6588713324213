// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/bake_mesh.hpp>
#include <import/scene_walk.hpp>

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

namespace glidar::import {

/// What had to be left out or made anew, over all parts.
struct Repairs {
  std::uint64_t not_finite = 0;  ///< triangles
  std::uint64_t bad_normals = 0;
  std::uint64_t unused_vertices = 0;
};

/// The file's material of a placed mesh.
std::size_t material_of(const Placed& placed);

/// Extends the box by the finite vertices that triangles use, in the model's frame.
void extend_box(Eigen::AlignedBox3d& box, const Placed& placed);

/// One placed mesh in the model's frame, relative to `origin`, vertices merged and its normals (and
/// tangents, if needed) there.
Mesh make_part(const Placed& placed, const Eigen::Vector3d& origin, const BakeOptions& options,
               const SlotNeeds& needs, Repairs& repairs);

}  // namespace glidar::import
