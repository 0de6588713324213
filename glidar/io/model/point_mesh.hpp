// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: meshes of built-in models in double precision. The functions use only + - *
// / and sqrt in double, which IEEE 754 rounds the same everywhere, so a mesh has the same bytes on
// every machine.

#include <glidar/core/mesh.hpp>

#include <cmath>
#include <vector>

namespace glidar {

/// Points in double precision and triangles.
struct PointMesh {
  std::vector<Eigen::Vector3d> points_m;
  std::vector<Triangle> triangles;
};

/// Dot product with a fixed order of additions.
inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

inline Eigen::Vector3d unit(const Eigen::Vector3d& v) {
  return v / std::sqrt(dot(v, v));
}

/// The unit sphere as an icosahedron split `levels` times: 20 * 4^levels triangles.
PointMesh icosphere(int levels);

/// Unit vertex normals of a closed smooth mesh: edge products divided by the squared edge lengths
/// (N. Max, "Weights for Computing Vertex Normals from Facet Normals", Journal of Graphics Tools
/// 4(2), 1999). Like angle weights they do not depend on the triangulation of a flat face, and they
/// need no arc cosine.
std::vector<Eigen::Vector3d> smooth_normals(const PointMesh& mesh);

}  // namespace glidar
