// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// The ranges of a mesh that have the same origin, as a mesh with one origin.
struct MeshPiece {
  Mesh mesh;
  std::vector<std::uint32_t> triangles;  ///< of the whole mesh, one per triangle of the piece
};

/// Cuts a mesh with several origins into one piece per origin, in the order of first use. Triangles
/// and vertices of a piece keep their order. Attributes are copied.
std::vector<MeshPiece> cut_at_origins(const Mesh& mesh);

/// A mesh of some triangles, given by ascending numbers, and of the vertices that they use. All
/// keep their order, attributes and origins.
Mesh extract_triangles(const Mesh& mesh, std::span<const std::uint32_t> triangles);

}  // namespace glidar
