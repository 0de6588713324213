// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>

namespace glidar {

/// How sound a mesh is. Edges and corners are told apart by their position alone, so that seams of
/// normals or uvs do not count as openings. Triangles with two corners at one place have no edges.
struct MeshCheck {
  double area_m2 = 0.0;
  double signed_volume_m3 = 0.0;           ///< above 0: fronts outside; says little of an open mesh
  std::uint64_t open_edges = 0;            ///< with one triangle
  std::uint64_t crowded_edges = 0;         ///< with more than two triangles
  std::uint64_t inconsistent_edges = 0;    ///< two triangles that turn opposite ways
  std::uint64_t degenerate_triangles = 0;  ///< area below 1e-12 of the longest side squared
  std::uint64_t duplicate_triangles = 0;   ///< beyond the first at the same three places
  std::uint64_t duplicate_vertices = 0;    ///< beyond the first at the same place
  std::uint64_t unused_vertices = 0;       ///< of no triangle
};

MeshCheck check_mesh(const Mesh& mesh);

}  // namespace glidar
