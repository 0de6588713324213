// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/judgement.hpp>

#include <glidar/render/surface.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// The weights of corners 1 and 2 where a beam meets a triangle's plane.
Eigen::Vector2f weights(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& point) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3d v0 = mesh.positions_m[t[0]].cast<double>();
  const Eigen::Vector3d e1 = mesh.positions_m[t[1]].cast<double>() - v0;
  const Eigen::Vector3d e2 = mesh.positions_m[t[2]].cast<double>() - v0;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double whole = normal.squaredNorm();
  const Eigen::Vector3d from = point - v0;
  return Eigen::Vector2d(normal.dot(from.cross(e2)) / whole, normal.dot(e1.cross(from)) / whole)
      .cast<float>();
}

}  // namespace

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

bool stops(const Resolver& resolver, const Beams& beams, std::size_t beam, bool cull_back_faces,
           const Found& candidate) {
  const Instance& instance = resolver.scene().instances[candidate.instance];
  const Mesh& mesh = resolver.mesh(candidate.instance);
  const ObjectRay ray = ray_in(resolver.view(candidate.instance), beams, beam);
  const TrianglePlane& plane = resolver.plane(candidate.instance, candidate.primitive);
  if (cull_back_faces && plane.normal.dot(ray.direction) > 0.0) return false;
  const std::uint16_t slot = material_slot(mesh, candidate.primitive);
  if (!(resolver.scene().materials[instance.materials[slot]].alpha_cutoff > 0.0F)) return true;
  const Eigen::Vector3d point = ray.origin + distance_to(plane, ray) * ray.direction;
  const SurfacePlace place{mesh, instance, candidate.primitive,
                           weights(mesh, candidate.primitive, point)};
  return !is_cut_out(resolver.scene(), place);
}

Judgement::Meeting Judgement::meet(const Found& candidate) const {
  const InstanceView& view = resolver.view(candidate.instance);
  const TrianglePlane& plane = resolver.plane(candidate.instance, candidate.primitive);
  const ObjectRay ray = ray_in(view, beams, beam);
  const double distance = distance_to(plane, ray);
  if (!(distance > 0.0)) return {.range_m = 0.0, .inside_m = 0.0, .cosine = 0.0};
  return {.range_m = view.scale * distance,
          .inside_m =
              view.scale * distance_inside(resolver.mesh(candidate.instance), candidate.primitive,
                                           plane.normal, ray.origin + distance * ray.direction),
          .cosine = plane.normal.dot(ray.direction)};
}

void Judgement::consider(const Found& candidate) {
  const Meeting at = meet(candidate);
  if (!(at.range_m > 0.0)) return;
  if (at.inside_m > closest_inside_m) {
    closest_inside_m = at.inside_m;
    closest = candidate;
  }
  const bool is_nearer =
      at.range_m < nearest_range_m ||
      (at.range_m == nearest_range_m && is_lower(candidate, nearest));  // in whatever order
  if (at.inside_m >= -slack_m && is_nearer) {
    nearest_range_m = at.range_m;
    nearest_cosine = at.cosine;
    nearest_slack_m = slack_m;
    nearest_inside_m = at.inside_m;
    nearest = candidate;
  }
}

void Judgement::consider_tie(const Found& candidate) {
  if (!is_lower(candidate, nearest)) return;
  const Meeting at = meet(candidate);
  if (!(at.range_m > 0.0) || !(at.inside_m >= -slack_m)) return;
  // Along the normal of the one that the beam meets more steeply: in the plane of the other the
  // range is that of rounding.
  const double cosine = std::max(std::abs(at.cosine), std::abs(nearest_cosine));
  const double apart_m = cosine * (at.range_m - nearest_range_m);
  if (apart_m <= slack_m + nearest_slack_m) nearest = candidate;
}

}  // namespace glidar
