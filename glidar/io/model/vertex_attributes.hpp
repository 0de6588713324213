// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>
#include <glidar/math/elementary.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace glidar {

/// The angle between two vectors of any length, in radians from 0 to pi; 0 unless both are finite
/// and not zero. It has the same bits with every C library, unlike std::atan2 for floats.
inline float angle_between_rad(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const double turns = atan2_turns(a.cross(b).norm(), a.dot(b));
  return static_cast<float>(2.0 * std::numbers::pi * turns);
}

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

/// Computes vertex normals: for each corner the sum of the unit normals of those faces around the
/// position whose angle to the corner's own face is at most the crease angle, weighted by
/// their angle there (Thuermer and Wuethrich, Computing vertex normals from polygonal facets, JGT
/// 3(1), 1998). If corners of one vertex get different normals, the vertex is split;
/// new vertices are appended; triangles keep their order. Degenerate faces contribute nothing.
/// Where more than 512 faces meet with a crease among them every corner keeps its face's normal.
/// `are_distinct`: no two vertices have the same position, which saves time.
void make_normals(Mesh& mesh, double crease_angle_rad, bool are_distinct = false);

/// Computes vertex tangents from normals and one uv set, similar to MikkTSpace (Mikkelsen,
/// Simulation of wrinkled surfaces revisited, 2008): per corner the face's +u direction, projected
/// onto the plane of the vertex normal, weighted by angle. A vertex between faces of mirrored and
/// unmirrored uvs is split. Requires normals and uvs; triangles keep their order.
void make_tangents(Mesh& mesh, std::size_t uv_set);

}  // namespace glidar
