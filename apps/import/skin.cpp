// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/skin.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <utility>

namespace glidar::import {
namespace {

Eigen::Matrix3d cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result.col(0) = m.col(1).cross(m.col(2));
  result.col(1) = m.col(2).cross(m.col(0));
  result.col(2) = m.col(0).cross(m.col(1));
  return result;
}

Eigen::Vector3f direction(const Eigen::Vector3d& v) {
  const double length = v.norm();
  if (!std::isfinite(length) || length == 0.0) return Eigen::Vector3f::Zero();
  return (v / length).cast<float>();
}

}  // namespace

void apply_skin(const std::vector<Eigen::Matrix4d>& skin, SourceMesh& mesh) {
  std::vector<bool> is_mirrored(skin.size());
  for (std::size_t v = 0; v < skin.size(); ++v) {
    const Eigen::Matrix3d linear = skin[v].topLeftCorner<3, 3>();
    is_mirrored[v] = linear.determinant() < 0.0;
    const double side = is_mirrored[v] ? -1.0 : 1.0;
    mesh.positions[v] = (skin[v] * mesh.positions[v].homogeneous()).head<3>();
    if (!mesh.normals.empty()) {
      mesh.normals[v] = direction(side * cofactors(linear) * mesh.normals[v].cast<double>());
    }
    if (mesh.tangents.empty()) continue;
    const Eigen::Vector3d tangent = mesh.tangents[v].head<3>().cast<double>();
    mesh.tangents[v].head<3>() = direction(linear * tangent);
    mesh.tangents[v][3] *= static_cast<float>(side);
  }
  for (Triangle& t : mesh.triangles) {
    if (is_mirrored[t[0]]) std::swap(t[1], t[2]);
  }
}

}  // namespace glidar::import
