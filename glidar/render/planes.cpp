// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/planes.hpp>

#include <cmath>

namespace glidar {

TrianglePlane plane_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
    return mesh.positions_m[mesh.triangles[triangle][k]].cast<double>();
  };
  const Eigen::Vector3d a = corner(0);
  const Eigen::Vector3d u = corner(1) - a;
  const Eigen::Vector3d v = corner(2) - a;
  // Without Eigen's products, which may add the terms in another order than the kernels.
  const double x = u.y() * v.z() - u.z() * v.y();
  const double y = u.z() * v.x() - u.x() * v.z();
  const double z = u.x() * v.y() - u.y() * v.x();
  const double length = std::sqrt(x * x + y * y + z * z);
  const Eigen::Vector3d normal(x / length, y / length, z / length);
  return {normal, normal.x() * a.x() + normal.y() * a.y() + normal.z() * a.z()};
}

}  // namespace glidar
