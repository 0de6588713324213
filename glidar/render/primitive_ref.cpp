// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/primitive_ref.hpp>

#include <glidar/render/surface.hpp>

namespace glidar {
namespace {

/// Barycentric weights of corners 1 and 2 at a point of the triangle's plane.
Eigen::Vector2f weights(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& point) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3d v0 = mesh.positions_m[t[0]].cast<double>();
  const Eigen::Vector3d e1 = mesh.positions_m[t[1]].cast<double>() - v0;
  const Eigen::Vector3d e2 = mesh.positions_m[t[2]].cast<double>() - v0;
  const Eigen::Vector3d normal = e1.cross(e2);
  const double whole = normal.squaredNorm();
  if (whole == 0.0) return Eigen::Vector2f::Constant(1.0F / 3.0F);
  const Eigen::Vector3d from = point - v0;
  return Eigen::Vector2d(normal.dot(from.cross(e2)) / whole, normal.dot(e1.cross(from)) / whole)
      .cast<float>();
}

}  // namespace

bool blocks_beam(const Resolver& resolver, const Beams& beams, std::size_t beam,
                 bool cull_back_faces, const PrimitiveRef& candidate) {
  const Instance& instance = resolver.scene().instances[candidate.instance];
  const Mesh& mesh = resolver.mesh(candidate.instance);
  const ObjectRay ray = ray_in(resolver.view(candidate.instance), beams, beam);
  const TrianglePlane plane = resolver.plane(candidate.instance, candidate.primitive);
  if (cull_back_faces && plane.normal.dot(ray.direction) > 0.0) return false;
  const std::uint16_t slot = material_slot(mesh, candidate.primitive);
  if (!(resolver.scene().materials[instance.materials[slot]].alpha_cutoff > 0.0F)) return true;
  const Eigen::Vector3d point = ray.origin + distance_to(plane, ray) * ray.direction;
  const SurfacePoint surface_point{mesh, instance, candidate.primitive,
                                   weights(mesh, candidate.primitive, point)};
  return !is_cut_out(resolver.scene(), surface_point);
}

}  // namespace glidar
