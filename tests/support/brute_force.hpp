// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/constants.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace glidar::testing {

/// The hit of a beam, from a test of every triangle in double. It shares no code with the
/// renderers.
struct Judged {
  std::uint32_t instance = kInvalidId;
  std::uint32_t primitive = kInvalidId;
  double range_m = kNaN;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< world, front side
  /// Distance in metres, over all triangles in front of the beam's hit, from the beam to the
  /// nearest border: if it is tiny, single precision may report another triangle, or none.
  double border_m = std::numeric_limits<double>::infinity();
};

/// Tests beams with all triangles of a scene, in its frame.
class BruteForce {
 public:
  explicit BruteForce(const Scene& scene) {
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) add(scene, i);
  }

  /// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997), both sides.
  [[nodiscard]] Judged judge(const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) const {
    Judged best;
    double best_range = std::numeric_limits<double>::infinity();
    for (const Facet& facet : facets_) {
      if (facet.is_far_from(origin, direction)) continue;
      const Eigen::Vector3d p = direction.cross(facet.e2);
      const double determinant = facet.e1.dot(p);
      if (determinant == 0.0) continue;
      const Eigen::Vector3d s = origin - facet.corner;
      const double u = s.dot(p) / determinant;
      const Eigen::Vector3d q = s.cross(facet.e1);
      const double v = direction.dot(q) / determinant;
      const double range = facet.e2.dot(q) / determinant;
      if (!(range > 0.0)) continue;
      const double twice_area_seen = std::abs(determinant);
      const double border =
          std::abs(std::min({u, v, 1.0 - u - v})) * twice_area_seen / facet.longest;
      const bool around = u > -0.01 && v > -0.01 && u + v < 1.01;
      if (around && range < best_range * 1.001) best.border_m = std::min(best.border_m, border);
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || range >= best_range) continue;
      best_range = range;
      best.instance = facet.instance;
      best.primitive = facet.primitive;
      best.range_m = range;
      best.normal = facet.e1.cross(facet.e2).normalized();
    }
    return best;
  }

 private:
  struct Facet {
    Eigen::Vector3d corner;
    Eigen::Vector3d e1;
    Eigen::Vector3d e2;
    std::uint32_t instance;
    std::uint32_t primitive;
    double longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
    double radius = 1.1 * std::max(e1.norm(), e2.norm());  ///< around the corner

    /// True where a beam's line is clearly outside of a sphere around the triangle and the points
    /// near its edges that judge() looks at; saves most of the time.
    [[nodiscard]] bool is_far_from(const Eigen::Vector3d& origin,
                                   const Eigen::Vector3d& direction) const {
      const Eigen::Vector3d s = corner - origin;
      const double reach = radius + 1e-9 * (std::abs(s.x()) + std::abs(s.y()) + std::abs(s.z()));
      return s.cross(direction).squaredNorm() > reach * reach;
    }
  };

  void add(const Scene& scene, std::uint32_t number) {
    const Instance& instance = scene.instances[number];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto corner = [&](std::uint32_t vertex) -> Eigen::Vector3d {
      return instance.world_from_object * (instance.scale * vertex_m(mesh, vertex));
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Eigen::Vector3d first = corner(a);
      facets_.push_back({first, corner(b) - first, corner(c) - first, number, t});
    }
  }

  std::vector<Facet> facets_;
};

}  // namespace glidar::testing
