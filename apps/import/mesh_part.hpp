// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace glidar::import {

/// What a part must have.
struct BakeNeeds {
  double crease_angle_rad = 0.0;
  bool tangents = false;      ///< its material has a normal map
  std::size_t normal_uv = 0;  ///< in this uv set
  bool is_last = false;       ///< no other part needs the mesh of the file: its memory is freed
};

/// Counts of vertices, triangles and normals that were left out or recomputed, over all parts.
struct Repairs {
  std::uint64_t not_finite = 0;  ///< triangles
  std::uint64_t bad_normals = 0;
  std::uint64_t unused_vertices = 0;
  std::uint64_t whole_faces = 0;  ///< of which nothing was left out
};

/// Visits the vertices of triangles, in the model's frame. Skips vertices outside the range of
/// single precision.
void for_used_vertices(const SourceMesh& mesh, const Placed& placed,
                       const std::function<void(const Eigen::Vector3d&)>& visit);

/// One placed mesh in the model's frame, relative to `origin`, vertices merged and its normals (and
/// tangents, if needed) there.
Mesh make_part(SourceMesh& mesh, const Placed& placed, const Eigen::Vector3d& origin,
               const BakeNeeds& needs, Repairs& repairs);

}  // namespace glidar::import
