// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/embree/settle.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar::embree {
namespace {

// Single precision rounds a coordinate of the geometry by 2^-24 of its size, and an edge function
// by a few of those; the hair is 16 times one.
constexpr double kHairPerRadius = 0x1p-20;
constexpr double kSlackPerLength = 0x1p-44;  // 256 roundings of a coordinate in double
// A beam this far inside (as a barycentric weight) is certain when the triangle is at least
// kCertainHairs hairs wide as the beam sees it.
constexpr float kCertainMargin = 1.0F / 64.0F;
constexpr double kCertainHairs = 256.0;
constexpr int kRingSteps = 8;
constexpr double kRingHairs = 2.0;

/// Two unit vectors that with the direction make a right-handed frame.
std::array<Eigen::Vector3d, 2> across(const Eigen::Vector3d& direction) {
  // No axis of a grid is parallel to this one, so that the hair never runs along its edges.
  static const Eigen::Vector3d kOblique = Eigen::Vector3d(0.786, 0.334, 0.520).normalized();
  static const Eigen::Vector3d kOther = Eigen::Vector3d(-0.334, 0.786, 0.520).normalized();
  Eigen::Vector3d first = direction.cross(kOblique);
  constexpr double kTooParallel = 0.01;  // squared sine
  if (first.squaredNorm() < kTooParallel) first = direction.cross(kOther);
  first.normalize();
  return {first, direction.cross(first)};
}

TraceRay rounded(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return {origin.cast<float>(), direction.cast<float>()};
}

/// How far inside the triangle a point of its plane lies: the smallest signed distance to an edge.
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

}  // namespace

Probe::Probe(const TraceSpace& space, const Resolver& resolver, const Beams& beams,
             bool cull_back_faces)
    : space_(space),
      resolver_(resolver),
      beams_(beams),
      cull_back_faces_(cull_back_faces),
      hair_(kHairPerRadius * space.radius),
      slack_(kSlackPerLength * (space.radius + space.sensor_in_trace.norm())) {}

FilterContext Probe::context() const {
  FilterContext context{};
  rtcInitIntersectContext(&context.embree);
  context.resolver = &resolver_;
  context.beams = &beams_;
  context.cull_back_faces = cull_back_faces_;
  return context;
}

Probe::ExactRay Probe::exact_ray(std::size_t beam) const {
  ExactRay ray{space_.sensor_in_trace, space_.trace_from_sensor * beams_.directions[beam]};
  if (!beams_.origins_m.empty()) {
    ray.origin += space_.trace_from_sensor * beams_.origins_m[beam] / space_.metres_per_unit;
  }
  constexpr double kClear = 1.001;  // the start must stay outside the sphere after rounding
  const double start = (space_.centre - ray.origin).dot(ray.direction) - kClear * space_.radius;
  if (start > 0.0) ray.origin += start * ray.direction;
  return ray;
}

TraceRay Probe::ray(std::size_t beam) const {
  const ExactRay exact = exact_ray(beam);
  return rounded(exact.origin + hair_ * across(exact.direction)[0], exact.direction);
}

bool Probe::is_doubtful(std::size_t beam, const Found& found) const {
  if (found.margin < kCertainMargin) return true;
  const InstanceView& view = resolver_.view(found.instance);
  const double cosine = resolver_.plane(found.instance, found.primitive)
                            .normal.dot(view.object_from_sensor * beams_.directions[beam]);
  const double hairs = hair_ * space_.metres_per_unit / view.scale * kCertainHairs;
  return double{found.twice_area} * cosine * cosine < hairs * hairs;
}

Found Probe::trace(std::size_t beam, const TraceRay& ray) const {
  FilterContext filter = context();
  RTCRayHit one{};
  one.ray.org_x = ray.origin.x();
  one.ray.org_y = ray.origin.y();
  one.ray.org_z = ray.origin.z();
  one.ray.dir_x = ray.direction.x();
  one.ray.dir_y = ray.direction.y();
  one.ray.dir_z = ray.direction.z();
  one.ray.tfar = std::numeric_limits<float>::infinity();
  one.ray.mask = ~0U;
  one.ray.id = static_cast<unsigned>(beam);
  one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(space_.scene, &filter.embree, &one);
  if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {kNoHit, kNoHit, 0.0F, 0.0F};
  const unsigned instance = one.hit.instID[0];
  return {instance == RTC_INVALID_GEOMETRY_ID ? 0U : instance, one.hit.primID, 0.0F, 0.0F};
}

Found Probe::settle(std::size_t beam, const Found& found) const {
  Found nearest{kNoHit, kNoHit, 0.0F, 0.0F};
  Found closest = found;
  double nearest_range = std::numeric_limits<double>::infinity();
  double closest_inside = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const Found& candidate) {
    const InstanceView& view = resolver_.view(candidate.instance);
    const TrianglePlane& plane = resolver_.plane(candidate.instance, candidate.primitive);
    const ObjectRay ray = ray_in(view, beams_, beam);
    const double distance = distance_to(plane, ray);
    const double inside =
        view.scale * distance_inside(resolver_.mesh(candidate.instance), candidate.primitive,
                                     plane.normal, ray.origin + distance * ray.direction);
    if (!(distance >= 0.0)) return false;
    if (inside > closest_inside) {
      closest_inside = inside;
      closest = candidate;
    }
    if (inside < -slack_ * space_.metres_per_unit || !(view.scale * distance < nearest_range)) {
      return false;
    }
    nearest_range = view.scale * distance;
    nearest = candidate;
    return true;
  };
  if (consider(found)) return found;

  const ExactRay exact = exact_ray(beam);
  const auto [side, up] = across(exact.direction);
  bool passes = false;
  for (int step = 0; step <= kRingSteps; ++step) {
    Eigen::Vector3d origin = exact.origin;
    if (step > 0) {
      const double angle = 2.0 * std::numbers::pi * (step - 0.5) / kRingSteps;
      origin += kRingHairs * hair_ * (std::cos(angle) * side + std::sin(angle) * up);
    }
    const Found candidate = trace(beam, rounded(origin, exact.direction));
    if (candidate.instance == kNoHit) {
      passes = true;
    } else {
      consider(candidate);
    }
  }
  if (nearest.instance != kNoHit) return nearest;
  return passes ? Found{kNoHit, kNoHit, 0.0F, 0.0F} : closest;
}

}  // namespace glidar::embree
