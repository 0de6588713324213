// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <render/common/rays.hpp>

#include <limits>
#include <map>
#include <utility>

namespace glidar::testing {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The 12 vertices of an icosahedron are cyclic permutations of (0, +-1, +-golden ratio).
Points icosahedron() {
  const double g = std::numbers::phi;
  return {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
          {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
}

/// Divides every triangle in four; the middle of an edge is one vertex for both its triangles.
Triangles subdivide(const Triangles& triangles, Points& points) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t i, std::uint32_t j) {
    const auto next = static_cast<std::uint32_t>(points.size());
    const auto [found, is_new] = middles.try_emplace(std::minmax(i, j), next);
    if (is_new) points.push_back((points[i] + points[j]).normalized());
    return found->second;
  };
  Triangles finer;
  for (const auto& [a, b, c] : triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace

TestMesh make_sphere(unsigned levels, double radius, const Eigen::Vector3d& centre) {
  Points points = icosahedron();
  for (Eigen::Vector3d& p : points) p.normalize();
  Triangles triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                         {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                         {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                         {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (unsigned level = 0; level < levels; ++level) triangles = subdivide(triangles, points);
  TestMesh mesh{{}, std::move(triangles)};
  for (const Eigen::Vector3d& p : points) {
    mesh.vertices.push_back((centre + radius * p).cast<float>());
  }
  return mesh;
}

TestMesh make_fan(std::uint32_t count, const Eigen::Vector3d& centre, double size,
                  Numbers& numbers) {
  TestMesh mesh{{centre.cast<float>()}, {}};
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + numbers.in(-0.15, 0.15)) / count;
    const double radius = size * numbers.in(0.2, 1.0);
    const Eigen::Vector3d offset(radius * std::cos(angle), radius * std::sin(angle),
                                 size * numbers.in(-0.05, 0.05));
    mesh.vertices.push_back((centre + offset).cast<float>());
    mesh.triangles.push_back({0, k + 1, (k + 1) % count + 1});
  }
  return mesh;
}

HitCandidate nearest_of_all(const TestMesh& mesh, const TestRay& ray) {
  const HitRay prepared = make_hit_ray(ray.origin, ray.direction);
  HitCandidate nearest{std::numeric_limits<double>::infinity(), 0, UINT32_MAX};
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const double distance = hit_distance(prepared, mesh.triangle(i));
    if (distance == 0.0) continue;
    const HitCandidate candidate{distance, 0, i};
    if (is_nearer(candidate, nearest)) nearest = candidate;
  }
  return nearest;
}

}  // namespace glidar::testing
