// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/embree/embree_world.hpp>
#include <glidar/render/resolve.hpp>

#include <algorithm>
#include <cstdint>

namespace glidar::embree {

/// A ray as Embree takes it, starting near the geometry.
struct TraceRay {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;
};

/// What Embree says of one ray.
struct Found {
  std::uint32_t instance;  ///< kNoHit: nothing
  std::uint32_t primitive;
  float margin;      ///< smallest of the three barycentric weights
  float twice_area;  ///< of the triangle, object units squared
};

template <class HitPacket>
Found found_in(const HitPacket& hit, unsigned lane) {
  const unsigned instance = hit.instID[0][lane];
  const Eigen::Vector3f cross(hit.Ng_x[lane], hit.Ng_y[lane], hit.Ng_z[lane]);
  return {.instance = instance == RTC_INVALID_GEOMETRY_ID ? 0U : instance,
          .primitive = hit.primID[lane],
          .margin = std::min({hit.u[lane], hit.v[lane], 1.0F - hit.u[lane] - hit.v[lane]}),
          .twice_area = cross.norm()};
}

/// Makes Embree's single-precision answers watertight and exact.
///
/// A ray aimed exactly at a vertex can slip through Embree's robust test: the signs of the edge
/// functions around the vertex are then all rounding noise. So every ray is traced a hair beside
/// the true beam, by an offset well above that noise, where signs are certain. The triangle found
/// is the true beam's unless the beam runs within a hair of its border; that is told from the
/// barycentric weights, and then the triangles around are judged in double on the true beam.
class Probe {
 public:
  Probe(const TraceSpace& space, const Resolver& resolver, const Beams& beams,
        bool cull_back_faces);

  [[nodiscard]] const TraceSpace& space() const { return space_; }
  [[nodiscard]] FilterContext context() const;

  /// The ray to trace for a beam, beside it by one hair.
  [[nodiscard]] TraceRay ray(std::size_t beam) const;

  /// True when the hair could have changed the triangle.
  [[nodiscard]] bool is_doubtful(std::size_t beam, const Found& found) const;

  /// The true beam's triangle among those around; instance kNoHit when the beam passes them all.
  [[nodiscard]] Found settle(std::size_t beam, const Found& found) const;

 private:
  /// The beam in the trace space, in double, from near the geometry.
  struct ExactRay {
    Eigen::Vector3d origin;
    Eigen::Vector3d direction;
  };
  [[nodiscard]] ExactRay exact_ray(std::size_t beam) const;
  [[nodiscard]] Found trace(std::size_t beam, const TraceRay& ray) const;

  const TraceSpace& space_;
  const Resolver& resolver_;
  const Beams& beams_;
  bool cull_back_faces_;
  double hair_;  ///< the offset, in units of the trace space
  double
      slack_;  ///< rounding of a point in double there: a beam this far outside a border is on it
};

}  // namespace glidar::embree
