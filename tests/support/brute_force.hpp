// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/constants.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

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

/// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997), both sides.
inline Judged judge(const Scene& scene, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& direction) {
  Judged best;
  double best_range = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Eigen::Vector3d corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] =
            instance.world_from_object * (instance.scale * vertex_m(mesh, mesh.triangles[t][k]));
      }
      const Eigen::Vector3d e1 = corner[1] - corner[0];
      const Eigen::Vector3d e2 = corner[2] - corner[0];
      const Eigen::Vector3d p = direction.cross(e2);
      const double determinant = e1.dot(p);
      if (determinant == 0.0) continue;
      const Eigen::Vector3d s = origin - corner[0];
      const double u = s.dot(p) / determinant;
      const Eigen::Vector3d q = s.cross(e1);
      const double v = direction.dot(q) / determinant;
      const double range = e2.dot(q) / determinant;
      if (!(range > 0.0)) continue;
      const double twice_area_seen = std::abs(determinant);
      const double longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
      const double border = std::abs(std::min({u, v, 1.0 - u - v})) * twice_area_seen / longest;
      const bool around = u > -0.01 && v > -0.01 && u + v < 1.01;
      if (around && range < best_range * 1.001) best.border_m = std::min(best.border_m, border);
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || range >= best_range) continue;
      best_range = range;
      best.instance = i;
      best.primitive = t;
      best.range_m = range;
      best.normal = e1.cross(e2).normalized();
    }
  }
  return best;
}

}  // namespace glidar::testing
