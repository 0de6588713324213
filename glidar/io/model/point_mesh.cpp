// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/point_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace glidar {
namespace {

/// The three points as a triangle whose front faces away from the origin.
Triangle outwards(const std::vector<Eigen::Vector3d>& points, const Triangle& corners) {
  const auto& [i, j, k] = corners;
  const Eigen::Vector3d normal = (points[j] - points[i]).cross(points[k] - points[i]);
  return dot(normal, points[i]) > 0.0 ? corners : Triangle{i, k, j};
}

std::vector<Eigen::Vector3d> icosahedron_corners() {
  const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
  std::vector<Eigen::Vector3d> corners;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-golden, golden}) {
      corners.push_back(unit({0.0, a, b}));
      corners.push_back(unit({a, b, 0.0}));
      corners.push_back(unit({b, 0.0, a}));
    }
  }
  return corners;
}

/// A face is any three points at a distance of one edge.
PointMesh icosahedron() {
  PointMesh mesh{icosahedron_corners(), {}};
  const auto joined = [&](std::uint32_t i, std::uint32_t j) {
    const Eigen::Vector3d edge = mesh.points_m[i] - mesh.points_m[j];
    return dot(edge, edge) < 2.0;  // a squared edge is 1.106, the next distance 2.894
  };
  for (std::uint32_t triple = 0; triple < 12 * 12 * 12; ++triple) {
    const Triangle corners = {triple / 144, triple / 12 % 12, triple % 12};
    const auto& [i, j, k] = corners;
    const bool is_face = i < j && j < k && joined(i, j) && joined(j, k) && joined(k, i);
    if (is_face) mesh.triangles.push_back(outwards(mesh.points_m, corners));
  }
  return mesh;
}

/// Splits every triangle into four; new points are projected to the unit sphere.
void split(PointMesh& mesh) {
  std::unordered_map<std::uint64_t, std::uint32_t> middles;
  middles.reserve(mesh.triangles.size() * 3 / 2);
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
    const auto [entry, is_new] =
        middles.try_emplace(edge, static_cast<std::uint32_t>(mesh.points_m.size()));
    if (is_new) mesh.points_m.push_back(unit(mesh.points_m[a] + mesh.points_m[b]));
    return entry->second;
  };
  std::vector<Triangle> quarters;
  quarters.reserve(mesh.triangles.size() * 4);
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    quarters.push_back({a, ab, ca});
    quarters.push_back({ab, b, bc});
    quarters.push_back({ca, bc, c});
    quarters.push_back({ab, bc, ca});
  }
  mesh.triangles = std::move(quarters);
}

}  // namespace

PointMesh icosphere(int levels) {
  PointMesh mesh = icosahedron();
  for (int level = 0; level < levels; ++level) split(mesh);
  return mesh;
}

std::vector<Eigen::Vector3d> smooth_normals(const PointMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.points_m.size(), Eigen::Vector3d::Zero());
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d& at = mesh.points_m[triangle[corner]];
      const Eigen::Vector3d to_next = mesh.points_m[triangle[(corner + 1) % 3]] - at;
      const Eigen::Vector3d to_last = mesh.points_m[triangle[(corner + 2) % 3]] - at;
      normals[triangle[corner]] +=
          to_next.cross(to_last) / (dot(to_next, to_next) * dot(to_last, to_last));
    }
  }
  for (Eigen::Vector3d& normal : normals) normal = unit(normal);
  return normals;
}

}  // namespace glidar
