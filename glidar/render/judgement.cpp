// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/judgement.hpp>

#include <algorithm>

namespace glidar {

double distance_inside(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& normal,
                       const Eigen::Vector3d& point) {
  const Triangle& corners = mesh.triangles[triangle];
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d from = mesh.positions_m[corners[k]].cast<double>();
    const Eigen::Vector3d to = mesh.positions_m[corners[(k + 1) % 3]].cast<double>();
    const Eigen::Vector3d edge = to - from;
    smallest = std::min(smallest, normal.dot(edge.cross(point - from)) / edge.norm());
  }
  return smallest;
}

void Judgement::consider(const Found& candidate) {
  const InstanceView& view = resolver.view(candidate.instance);
  const TrianglePlane& plane = resolver.plane(candidate.instance, candidate.primitive);
  const ObjectRay ray = ray_in(view, beams, beam);
  const double distance = distance_to(plane, ray);
  if (!(distance > 0.0)) return;
  const double inside_m =
      view.scale * distance_inside(resolver.mesh(candidate.instance), candidate.primitive,
                                   plane.normal, ray.origin + distance * ray.direction);
  if (inside_m > closest_inside_m) {
    closest_inside_m = inside_m;
    closest = candidate;
  }
  if (inside_m >= -slack_m && view.scale * distance < nearest_range_m) {
    nearest_range_m = view.scale * distance;
    nearest = candidate;
  }
}

}  // namespace glidar
