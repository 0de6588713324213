// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// For every vertex the first vertex at the same position (compared bit by bit, without tolerance,
/// so that small models keep their shape).
std::vector<std::uint32_t> first_at_position(const std::vector<Eigen::Vector3f>& positions);

/// Merges vertices whose attributes are all bit-identical and removes those that no triangle
/// uses. Triangles keep their order. Vertices keep the order of their first use in the array.
void weld_vertices(Mesh& mesh);

/// The mesh with only the vertices `kept` (in any order), in that order.
/// `renumbered[old]` is the new index of each old vertex that a triangle uses.
void keep_vertices(Mesh& mesh, const std::vector<std::uint32_t>& kept,
                   const std::vector<std::uint32_t>& renumbered);

}  // namespace glidar
