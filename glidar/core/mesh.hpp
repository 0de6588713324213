// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar {

using Triangle = std::array<std::uint32_t, 3>;

/// The origin of a range of vertices and triangles, which ends where the next one begins.
struct MeshOrigin {
  std::uint32_t first_vertex = 0;
  std::uint32_t first_triangle = 0;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
};

/// A triangle mesh in its own object frame (metres, right-handed).
/// The position of a vertex is `origin_m + positions_m[i]`, or, if `origins` is not empty, the
/// origin of its range + positions_m[i] (vertex_m() handles both): single precision is relative to
/// a nearby origin, so that parts far from the frame's zero and from each other keep their detail.
/// V vertices, T triangles. From its front, the corners of a triangle are counter-clockwise.
struct Mesh {
  std::string name;
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> positions_m;         ///< V
  std::vector<Eigen::Vector3f> normals;             ///< V unit vectors; empty: flat shading
  std::array<std::vector<Eigen::Vector2f>, 2> uvs;  ///< two sets of V, v upwards; empty: none
  std::vector<Eigen::Vector4f>
      tangents;  ///< V, xyz along +u, w = sign of the bitangent; empty: none
  std::vector<Eigen::Vector3f>
      colours;                      ///< V, rgb 0..1, multiplies the diffuse colour; empty: white
  std::vector<Triangle> triangles;  ///< T, each corner < V
  std::vector<std::uint16_t> material_slots;  ///< T, index into Instance::materials; empty: all 0
  /// Ranges in increasing order, the first from vertex 0 and triangle 0; the triangles of a range
  /// use its own vertices only. Empty: origin_m applies to all vertices; otherwise origin_m is not
  /// used.
  std::vector<MeshOrigin> origins = {};
};

/// The origin of a vertex's position, in the object frame.
const Eigen::Vector3d& origin_of(const Mesh& mesh, std::uint32_t vertex);

/// The position of a vertex in the object frame, m.
inline Eigen::Vector3d vertex_m(const Mesh& mesh, std::uint32_t vertex) {
  return origin_of(mesh, vertex) + mesh.positions_m[vertex].cast<double>();
}

/// The box around all finite vertices, in the object frame; empty box for an empty mesh.
Eigen::AlignedBox3d bounds(const Mesh& mesh);

/// The slot of a triangle's material.
inline std::uint16_t material_slot(const Mesh& mesh, std::uint32_t triangle) {
  return mesh.material_slots.empty() ? std::uint16_t{0} : mesh.material_slots[triangle];
}

/// One past the largest slot that a triangle uses (at least 1).
std::uint32_t slot_count(const Mesh& mesh);

/// Throws Error unless every array has its stated size, every corner is a vertex of the triangle's
/// own range, ranges increase and every position is finite.
void validate(const Mesh& mesh);

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
