// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/comparison.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

double float_step(double value) {
  const auto single = static_cast<float>(value);
  return static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity())) -
         static_cast<double>(single);
}

/// The nearest hit of a ray.
struct Nearest {
  ExactHit hit;
  std::uint32_t instance = kInvalidId;
};

Nearest find_nearest(const ExactScene& scene, const RealVector& origin,
                     const RealVector& direction) {
  Nearest nearest;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const ClosedForm& form = scene.shapes[i].form;
    const ExactHit hit =
        scene.is_from_inside
            ? intersect_from_inside(form, origin, direction, scene.edge_tolerance_m)
            : intersect(form, origin, direction, scene.edge_tolerance_m);
    if (!hit.clear) return {.hit = {.hit = false, .clear = false, .range_m = 0.0L, .normal = {}}};
    if (!hit.hit || (nearest.hit.hit && nearest.hit.range_m <= hit.range_m)) continue;
    nearest = {hit, i};
  }
  return nearest;
}

using RealTriangle = std::array<RealVector, 3>;

RealTriangle triangle_of(const PlacedShape& placed, std::uint32_t triangle) {
  const Mesh& mesh = placed.shape.mesh;
  RealTriangle corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = exact_vertex(mesh, mesh.triangles[triangle][k], placed.scale, placed.pose);
  }
  return corner;
}

RealVector normal_of(const RealTriangle& corner) {
  return (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
}

/// True if a point is in a triangle of a placed shape, within the tolerance.
bool contains(const PlacedShape& placed, std::uint32_t triangle, const RealVector& point,
              Real tolerance_m) {
  if (triangle >= placed.shape.mesh.triangles.size()) return false;
  RealTriangle corner = triangle_of(placed, triangle);
  const RealVector normal = normal_of(corner);
  for (RealVector& c : corner) c -= point;
  if (std::abs(normal.dot(corner[0])) > tolerance_m) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const RealVector edge = corner[(k + 1) % 3] - corner[k];
    if (normal.dot(corner[k].cross(edge)) < -tolerance_m * edge.norm()) return false;
  }
  return true;
}

void add_errors(const ExactHit& exact, const ReportedHit& reported, VerifyResult& result) {
  const auto error_m =
      static_cast<double>(std::abs(static_cast<Real>(reported.range_m) - exact.range_m));
  result.range_error_m = std::max(result.range_error_m, error_m);
  result.range_error_ulp =
      std::max(result.range_error_ulp, error_m / float_step(static_cast<double>(exact.range_m)));
  const RealVector& normal = reported.normal;
  const double angle_rad = portable_atan2(static_cast<double>(exact.normal.cross(normal).norm()),
                                          static_cast<double>(exact.normal.dot(normal)));
  result.normal_error_rad = std::max(result.normal_error_rad, angle_rad);
}

}  // namespace

PlacedShape place_shape(const Shape& shape, double scale, const ExactPose& pose) {
  return {
      .shape = shape, .scale = scale, .pose = pose, .form = make_closed_form(shape, scale, pose)};
}

void compare_beam(const ExactScene& scene, const RealVector& origin, const RealVector& direction,
                  const ReportedHit& reported, VerifyResult& result) {
  ++result.rays;
  const Nearest exact = find_nearest(scene, origin, direction);
  if (!exact.hit.clear) {
    ++result.near_edges;
    return;
  }
  const bool is_hit = reported.instance != kInvalidId;
  ++(exact.hit.hit ? result.compared_hits : result.compared_misses);
  if (is_hit && !exact.hit.hit) ++result.wrong_hits;
  if (!is_hit && exact.hit.hit) ++result.wrong_misses;
  if (!is_hit || !exact.hit.hit) return;
  const PlacedShape& shape = scene.shapes[exact.instance];
  const RealVector point = origin + exact.hit.range_m * direction;
  const Real tolerance_m =
      kIdTolerance * (exact.hit.range_m + shape.pose.shift.norm() + static_cast<Real>(shape.scale));
  if (reported.instance != exact.instance ||
      !contains(shape, reported.primitive, point, tolerance_m)) {
    ++result.wrong_ids;
  }
  // At an edge, the normal of any adjacent triangle is correct.
  ExactHit hit = exact.hit;
  if (scene.edge_tolerance_m == 0.0 && reported.instance == exact.instance &&
      reported.primitive < shape.shape.mesh.triangles.size()) {
    hit.normal = normal_of(triangle_of(shape, reported.primitive));
    if (hit.normal.dot(direction) > 0.0L) hit.normal = -hit.normal;
  }
  add_errors(hit, reported, result);
}

VerifyResult compare_cast(const ExactScene& scene, const Pose& world_from_sensor,
                          const Beams& beams, const Hits& hits) {
  const Eigen::Matrix<Real, 3, 3> world_from_axes = world_from_sensor.linear().cast<Real>();
  VerifyResult result;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    RealVector origin = RealVector::Zero();
    if (!beams.origins_m.empty()) origin = world_from_axes * beams.origins_m[i].cast<Real>();
    compare_beam(scene, origin, world_from_axes * beams.directions[i].cast<Real>(),
                 {.instance = hits.instance[i],
                  .primitive = hits.primitive[i],
                  .range_m = hits.range_m[i],
                  .normal = world_from_axes * hits.normal[i].cast<Real>()},
                 result);
  }
  return result;
}

}  // namespace glidar
