// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/embree/settle.hpp>

#include <glidar/core/simd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glidar::embree {
namespace {

// Single precision rounds a coordinate of the geometry by 2^-24 of its size, and an edge function
// by a few of those; the hair is 16 times one.
constexpr double kHairPerRadius = 0x1p-20;
// Where some is far smaller or nearer than the rest, such as a satellite before the Earth, the hair
// is for that: for the rest it may be within rounding.
constexpr double kMostReaches = 16.0;
constexpr double kClear =
    1.001;  // rays start outside the sphere around the geometry, also after rounding
// A beam this far inside its triangle is certain: the hair itself, and as much for the rounding of
// Embree's weights and normal.
constexpr double kCertainHairs = 4.0;
constexpr float kLargestCoordinate = 1e18F;  // Embree stops the program at numbers it cannot square

/// An axis far from the direction and from the axes of any grid, so that a hair across both never
/// runs along a grid's edges.
Eigen::Vector3d axis_across(const Eigen::Vector3d& direction) {
  static const Eigen::Vector3d kOblique = Eigen::Vector3d(0.786, 0.334, 0.520).normalized();
  static const Eigen::Vector3d kOther = Eigen::Vector3d(-0.334, 0.786, 0.520).normalized();
  constexpr double kTooParallel = 0.8;
  return std::abs(direction.dot(kOblique)) > kTooParallel ? kOther : kOblique;
}

/// What the rays of a tile have in common.
struct Launch {
  const TraceSpace& space;
  double clear_radius;
  Eigen::Vector3f hair;  ///< its length times axis_across()
};

/// Where beams start in the trace space.
inline void find_origins(const TraceSpace& space, const BeamBlock& in_sensor,
                         Lanes3<double>& origin) {
  const Eigen::Vector3d& sensor = space.sensor_in_trace;
  for (unsigned i = 0; i < kLanes; ++i) origin.x[i] = sensor.x();
  for (unsigned i = 0; i < kLanes; ++i) origin.y[i] = sensor.y();
  for (unsigned i = 0; i < kLanes; ++i) origin.z[i] = sensor.z();
  if (!in_sensor.has_origins) return;
  Lanes3<double> offset_m;
  rotate(space.trace_from_sensor, in_sensor.origin_m, offset_m);
  for (unsigned i = 0; i < kLanes; ++i) origin.x[i] += offset_m.x[i] / space.metres_per_unit;
  for (unsigned i = 0; i < kLanes; ++i) origin.y[i] += offset_m.y[i] / space.metres_per_unit;
  for (unsigned i = 0; i < kLanes; ++i) origin.z[i] += offset_m.z[i] / space.metres_per_unit;
}

/// Directions into the trace space; origins along them to where the geometry may begin, and a hair
/// to the side. A lane is valid where its direction is a number.
GLIDAR_SIMD void launch_rays(const Launch& launch, const BeamBlock& in_sensor, Lanes<int>& valid,
                             RayHits& rays) {
  Lanes3<double> d;
  Lanes3<double> origin;
  rotate(launch.space.trace_from_sensor, in_sensor.direction, d);
  find_origins(launch.space, in_sensor, origin);
  const Eigen::Vector3d& c = launch.space.centre;
  const Eigen::Vector3f& h = launch.hair;
  RTCRay16& ray = rays.ray;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double along = (c.x() - origin.x[i]) * d.x[i] + (c.y() - origin.y[i]) * d.y[i] +
                         (c.z() - origin.z[i]) * d.z[i] - launch.clear_radius;
    const double start = along > 0.0 ? along : 0.0;
    const auto x = static_cast<float>(d.x[i]);
    const auto y = static_cast<float>(d.y[i]);
    const auto z = static_cast<float>(d.z[i]);
    ray.dir_x[i] = x;
    ray.dir_y[i] = y;
    ray.dir_z[i] = z;
    ray.org_x[i] = static_cast<float>(origin.x[i] + start * d.x[i]) + (y * h.z() - z * h.y());
    ray.org_y[i] = static_cast<float>(origin.y[i] + start * d.y[i]) + (z * h.x() - x * h.z());
    ray.org_z[i] = static_cast<float>(origin.z[i] + start * d.z[i]) + (x * h.y() - y * h.x());
    // Bitwise, so that the loop stays one of vectors; NaN compares false.
    const int reached = static_cast<int>(std::abs(ray.org_x[i]) < kLargestCoordinate) &
                        static_cast<int>(std::abs(ray.org_y[i]) < kLargestCoordinate) &
                        static_cast<int>(std::abs(ray.org_z[i]) < kLargestCoordinate) &
                        static_cast<int>(x == x);
    valid[i] &= -reached;
  }
  for (unsigned i = 0; i < kLanes; ++i) ray.tnear[i] = 0.0F;
  for (unsigned i = 0; i < kLanes; ++i) ray.tfar[i] = std::numeric_limits<float>::infinity();
  for (unsigned i = 0; i < kLanes; ++i) ray.time[i] = 0.0F;
  for (unsigned i = 0; i < kLanes; ++i) ray.mask[i] = ~0U;  // packaged Embree has ray masks
  for (unsigned i = 0; i < kLanes; ++i) ray.flags[i] = 0;
  for (unsigned i = 0; i < kLanes; ++i) rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  for (unsigned i = 0; i < kLanes; ++i) rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

/// A bit for every lane whose distance to its triangle's border, as the beam sees it, may be under
/// `needed` (object units): smallest weight times smallest height times the cosine. Also for lanes
/// whose beam starts on the triangle.
GLIDAR_SIMD std::uint32_t doubt(const RTCHit16& hit, const ExactBlock& exact,
                                const Lanes<float>& needed, const Lanes<float>& narrowness) {
  Lanes<std::uint32_t> bits;
  for (unsigned i = 0; i < kLanes; ++i) {
    const float u = hit.u[i];
    const float v = hit.v[i];
    const float uv = u < v ? u : v;
    const float margin = 1.0F - u - v < uv ? 1.0F - u - v : uv;
    const auto cosine = static_cast<float>(exact.cosine[i]);
    const float seen = margin * (cosine < 0.0F ? -cosine : cosine);
    const int ahead = static_cast<int>(static_cast<float>(exact.distance[i]) > 0.0F);
    const int certain = static_cast<int>(seen >= needed[i] * narrowness[i]) & ahead;
    bits[i] = static_cast<std::uint32_t>(certain ^ 1) << i;
  }
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < kLanes; ++i) mask |= bits[i];
  return mask;
}

}  // namespace

Probe::Probe(const World& world, const Resolver& resolver, const ExactSearch& search,
             const CastRequest& request)
    : world_(world),
      space_(world.space()),
      resolver_(resolver),
      search_(search),
      beams_(request.beams),
      cull_back_faces_(request.cull_back_faces),
      hair_(kHairPerRadius * std::min(space_.radius, kMostReaches * space_.least_reach)),
      slack_(slack(space_.radius + space_.sensor_in_trace.norm())) {}

FilterContext Probe::context() const {
  FilterContext context{};
  init_context(context.embree);
  context.resolver = &resolver_;
  context.beams = &beams_;
  context.cull_back_faces = cull_back_faces_;
  return context;
}

/// As much as single precision may move a beam where it hits this instance.
double Probe::hair_of(std::uint32_t instance) const {
  return std::max(hair_, kHairPerRadius * world_.reach(instance));
}

void Probe::set_rays(const std::array<std::size_t, kLanes>& beam, const BeamBlock& in_sensor,
                     Lanes<int>& valid, RayHits& rays) const {
  for (unsigned i = 0; i < kLanes; ++i) rays.ray.id[i] = static_cast<unsigned>(beam[i]);
  const Eigen::Vector3d middle = space_.trace_from_sensor * in_sensor.direction.get(0);
  launch_rays({.space = space_,
               .clear_radius = kClear * space_.radius,
               .hair = (hair_ * axis_across(middle)).cast<float>()},
              in_sensor, valid, rays);
}

std::uint32_t Probe::doubtful(const HitBlock& block, const ExactBlock& exact,
                              const RayHits& rays) const {
  Lanes<float> needed;
  Lanes<float> narrowness;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double hairs_m = kCertainHairs * hair_of(block.instance[i]) * space_.metres_per_unit;
    needed[i] = static_cast<float>(hairs_m / resolver_.view(block.instance[i]).scale);
    narrowness[i] = *world_.narrowness(block.instance[i], block.primitive[i]);
  }
  return doubt(rays.hit, exact, needed, narrowness) & block.mask;
}

Found Probe::settle(std::size_t beam, const Found& found) const {
  Judgement judgement{.resolver = resolver_,
                      .beams = beams_,
                      .beam = beam,
                      .slack_m = slack_ * space_.metres_per_unit};
  judgement.consider(found);
  return judgement.is_clear() ? found : search_.nearest(beam);
}

}  // namespace glidar::embree
