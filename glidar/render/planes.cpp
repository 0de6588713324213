// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/planes.hpp>

#include <algorithm>

namespace glidar {
namespace {

Eigen::Vector3d corner(const Mesh& mesh, std::uint32_t triangle, std::size_t k) {
  return mesh.positions_m[mesh.triangles[triangle][k]].cast<double>();
}

double longest_edge(const Mesh& mesh, std::uint32_t triangle) {
  const Eigen::Vector3d v0 = corner(mesh, triangle, 0);
  const Eigen::Vector3d v1 = corner(mesh, triangle, 1);
  const Eigen::Vector3d v2 = corner(mesh, triangle, 2);
  return std::max({(v1 - v0).norm(), (v2 - v1).norm(), (v0 - v2).norm()});
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

std::vector<float> triangle_narrowness(const Mesh& mesh) {
  std::vector<float> narrowness(mesh.triangles.size());
  for (std::uint32_t i = 0; i < narrowness.size(); ++i) {
    const Eigen::Vector3d v0 = corner(mesh, i, 0);
    const Eigen::Vector3d cross = (corner(mesh, i, 1) - v0).cross(corner(mesh, i, 2) - v0);
    narrowness[i] = static_cast<float>(longest_edge(mesh, i) / cross.norm());
  }
  return narrowness;
}

}  // namespace glidar
