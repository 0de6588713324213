// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/planes.hpp>

namespace glidar {
namespace {

Eigen::Vector3d corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]].cast<double>();
}

}  // namespace

std::vector<TrianglePlane> triangle_planes(const Mesh& mesh) {
  std::vector<TrianglePlane> planes(mesh.triangles.size());
  for (std::uint32_t i = 0; i < planes.size(); ++i) {
    const Eigen::Vector3d v0 = corner(mesh, i, 0);
    const Eigen::Vector3d cross = (corner(mesh, i, 1) - v0).cross(corner(mesh, i, 2) - v0);
    planes[i].normal = cross / cross.norm();
    planes[i].offset = planes[i].normal.dot(v0);
  }
  return planes;
}

}  // namespace glidar
