// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>

namespace glidar {

/// Results of mesh checks. Edges and vertices are identified by position only, so that seams of
/// normals or uvs do not count as open edges. Triangles with two vertices at the same position have
/// no edges.
struct MeshCheck {
  double area_m2 = 0.0;
  double signed_volume_m3 = 0.0;    ///< positive: fronts outside; not meaningful for open meshes
  std::uint64_t open_edges = 0;     ///< with one triangle
  std::uint64_t crowded_edges = 0;  ///< with more than two triangles
  std::uint64_t inconsistent_edges = 0;    ///< two triangles with opposite orientation
  std::uint64_t degenerate_triangles = 0;  ///< area below 1e-12 of the longest side squared
  std::uint64_t duplicate_triangles = 0;   ///< after the first with the same three positions
  std::uint64_t duplicate_vertices = 0;    ///< after the first at the same position
  std::uint64_t unused_vertices = 0;       ///< without a triangle
};

MeshCheck check_mesh(const Mesh& mesh);

}  // namespace glidar
