// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/comparison.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

namespace glidar {
namespace {

constexpr double kAny = -1.0;

/// A limit of the method, listed in docs/internals/accuracy.md.
struct Entry {
  std::string_view name;   ///< of the case
  std::string_view shape;  ///< empty: any
  double distance_m;       ///< kAny: any
  std::string_view reason;
  double max_wrong_share;  ///< above the measured share, because processors differ
  double max_range_error_ulp;
};

constexpr std::array<Entry, 1> kKnown = {{
    {"above a planet", "", kAny,
     "in double, the sensor's position in units of the planet's radius is exact to 1e-9 m", 0.0,
     0.1},
}};

}  // namespace

KnownFailure known_failure(const AccuracyCase& row) {
  const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Entry& entry) {
    return entry.name == row.name && (entry.shape.empty() || entry.shape == row.shape) &&
           (entry.distance_m == kAny || entry.distance_m == row.distance_m);
  });
  if (known == kKnown.end()) return {};
  return {std::string(known->reason), known->max_wrong_share, known->max_range_error_ulp};
}

namespace {

double float_step(double value) {
  const auto single = static_cast<float>(value);
  return static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity())) -
         static_cast<double>(single);
}

/// Whether a ray is far from the sphere around a shape, whose mesh is inside the unit sphere.
bool passes(const PlacedShape& placed, const RealVector& origin, const RealVector& direction) {
  constexpr Real kMargin = 1.01L;
  const RealVector centre = placed.pose.rotation * (static_cast<Real>(placed.scale) *
                                                    placed.shape.mesh.origin_m.cast<Real>()) +
                            placed.pose.shift - origin;
  const Real along = centre.dot(direction);
  const Real radius = kMargin * static_cast<Real>(placed.scale);
  return centre.squaredNorm() - along * along > radius * radius;
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
    if (!scene.is_from_inside && passes(scene.shapes[i], origin, direction)) continue;
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

/// A beam that hit the right triangle.
struct ComparedBeam {
  const PlacedShape& shape;
  const ExactContact& contact;
  const RealVector& direction;  ///< world axes
  const RealMatrix& world_from_axes;
};

/// The weights of the corners of a triangle at a point of it.
RealVector weights_at(const RealTriangle& corner, const RealVector& point) {
  const RealVector normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const Real area = normal.squaredNorm();
  const auto weight = [&](std::size_t k) {
    const RealVector& a = corner[(k + 1) % 3];
    return (corner[(k + 2) % 3] - a).cross(point - a).dot(normal) / area;
  };
  return {weight(0), weight(1), weight(2)};
}

/// The smallest height of a triangle.
Real height_of(const RealTriangle& corner) {
  Real longest = 0.0L;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (corner[(k + 1) % 3] - corner[k]).norm());
  return (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm() / longest;
}

/// The interpolated vertex normals, unit, world axes.
RealVector smooth_normal(const PlacedShape& placed, std::uint32_t triangle,
                         const RealVector& weights) {
  const Mesh& mesh = placed.shape.mesh;
  RealVector normal = RealVector::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    normal += weights[static_cast<Eigen::Index>(k)] *
              mesh.normals[mesh.triangles[triangle][k]].cast<Real>();
  }
  return (placed.pose.rotation * normal).normalized();
}

double distance(const RealVector& a, const RealVector& b) {
  return static_cast<double>((a - b).norm());
}

/// Compares the columns other than range, ids and normal.
void compare_columns(const ComparedBeam& beam, const Beams& beams, const Hits& hits, std::size_t i,
                     VerifyResult& result) {
  const PlacedShape& placed = beam.shape;
  const RealTriangle corner = triangle_of(placed, hits.primitive[i]);
  RealVector normal = normal_of(corner);
  const Real side = normal.dot(beam.direction) > 0.0L ? -1.0L : 1.0L;
  normal *= side;
  const auto value = [](Real real) { return static_cast<double>(real); };
  const Real depth_m = beam.contact.point.dot(beam.world_from_axes * beams.boresight.cast<Real>());
  const double depth_error_m = std::abs(value(static_cast<Real>(hits.depth_m[i]) - depth_m));
  const double depth_error_ulp = depth_error_m / float_step(value(beam.contact.range_m));
  result.range_error_ulp = std::max(result.range_error_ulp, depth_error_ulp);
  result.check(value(hits.cos_incidence[i] + normal.dot(beam.direction)), kColumnBound);
  const double rounding = beam.contact.tolerance_m / value(height_of(corner));
  const RealVector weights = weights_at(corner, beam.contact.point);
  const RealVector smooth =
      placed.shape.mesh.normals.empty()
          ? normal
          : RealVector(side * smooth_normal(placed, hits.primitive[i], weights));
  const double smooth_bound = kColumnBound + (placed.shape.mesh.normals.empty() ? 0.0 : rounding);
  result.check(distance(beam.world_from_axes * hits.shading_normal[i].cast<Real>(), smooth),
               smooth_bound);
  result.check(value(hits.cos_shading[i] + smooth.dot(beam.direction)), smooth_bound);
  result.check(value(hits.barycentrics[i].x() - weights.y()), kColumnBound + rounding);
  result.check(value(hits.barycentrics[i].y() - weights.z()), kColumnBound + rounding);
  const RealVector in_object = placed.pose.rotation.transpose() *
                               (beam.contact.point - placed.pose.shift) /
                               static_cast<Real>(placed.scale);
  result.check(distance(hits.object_point_m[i].cast<Real>(), in_object),
               beam.contact.tolerance_m / placed.scale + kIdTolerance * value(in_object.norm()));
}

/// Compares all columns of a hit.
void compare_hit(const ExactScene& scene, const RealMatrix& world_from_axes, const Beams& beams,
                 const Hits& hits, std::size_t i, VerifyResult& result) {
  RealVector origin = RealVector::Zero();
  if (!beams.origins_m.empty()) origin = world_from_axes * beams.origins_m[i].cast<Real>();
  const RealVector direction = world_from_axes * beams.directions[i].cast<Real>();
  const auto contact = compare_beam(scene, origin, direction,
                                    {.instance = hits.instance[i],
                                     .primitive = hits.primitive[i],
                                     .range_m = hits.range_m[i],
                                     .normal = world_from_axes * hits.normal[i].cast<Real>()},
                                    result);
  if (!contact) return;
  compare_columns({scene.shapes[contact->instance], *contact, direction, world_from_axes}, beams,
                  hits, i, result);
}

}  // namespace

PlacedShape place_shape(const Shape& shape, double scale, const ExactPose& pose) {
  return {
      .shape = shape, .scale = scale, .pose = pose, .form = make_closed_form(shape, scale, pose)};
}

std::optional<ExactContact> compare_beam(const ExactScene& scene, const RealVector& origin,
                                         const RealVector& direction, const ReportedHit& reported,
                                         VerifyResult& result) {
  ++result.rays;
  const Nearest exact = find_nearest(scene, origin, direction);
  if (!exact.hit.clear) {
    ++result.near_edges;
    return {};
  }
  const bool is_hit = reported.instance != kInvalidId;
  ++(exact.hit.hit ? result.compared_hits : result.compared_misses);
  if (is_hit && !exact.hit.hit) ++result.wrong_hits;
  if (!is_hit && exact.hit.hit) ++result.wrong_misses;
  if (!is_hit || !exact.hit.hit) return {};
  const PlacedShape& shape = scene.shapes[exact.instance];
  const RealVector point = origin + exact.hit.range_m * direction;
  const Real tolerance_m =
      kIdTolerance * (exact.hit.range_m + shape.pose.shift.norm() + static_cast<Real>(shape.scale));
  const bool is_right = reported.instance == exact.instance &&
                        contains(shape, reported.primitive, point, tolerance_m);
  if (!is_right) ++result.wrong_ids;
  // At an edge, the normal of any adjacent triangle is correct.
  ExactHit hit = exact.hit;
  if (scene.edge_tolerance_m == 0.0 && reported.instance == exact.instance &&
      reported.primitive < shape.shape.mesh.triangles.size()) {
    hit.normal = normal_of(triangle_of(shape, reported.primitive));
    if (hit.normal.dot(direction) > 0.0L) hit.normal = -hit.normal;
  }
  add_errors(hit, reported, result);
  if (!is_right) return {};
  return ExactContact{exact.instance, exact.hit.range_m, point, static_cast<double>(tolerance_m)};
}

VerifyResult compare_cast(const ExactScene& scene, const Pose& world_from_sensor,
                          const Beams& beams, const Hits& hits, ThreadPool& thread_pool,
                          std::size_t stride) {
  constexpr std::size_t kGrain = 256;
  const RealMatrix world_from_axes = world_from_sensor.linear().cast<Real>();
  VerifyResult result;
  std::mutex adding;
  const auto compare = [&](std::size_t begin, std::size_t end) {
    VerifyResult part;
    for (std::size_t i = begin; i < end; ++i)
      compare_hit(scene, world_from_axes, beams, hits, i * stride, part);
    const std::lock_guard lock(adding);
    result.add(part);
  };
  thread_pool.parallel_for((beams.size() + stride - 1) / stride, kGrain, compare);
  return result;
}

}  // namespace glidar
