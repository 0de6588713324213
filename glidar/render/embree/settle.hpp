// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/embree/embree_world.hpp>
#include <glidar/render/exact_search.hpp>
#include <glidar/render/resolve.hpp>

#include <cstdint>

namespace glidar::embree {

/// Makes Embree's single-precision answers watertight and exact.
///
/// A ray aimed exactly at a vertex can slip through Embree's robust test: the signs of the edge
/// functions around the vertex are then all rounding noise. So every ray is traced a hair beside
/// the true beam, by an offset well above that noise, where signs are certain. The triangle found
/// is the true beam's unless the beam runs within a hair of its border; that is told from the
/// barycentric weights, and then the true beam is tested in double.
class Probe {
 public:
  Probe(const World& world, const Resolver& resolver, const ExactSearch& search,
        const CastRequest& request);

  [[nodiscard]] const TraceSpace& space() const { return space_; }
  [[nodiscard]] FilterContext context() const;

  /// Sets the lanes' rays beside their beams, starting near the geometry. `valid` (-1 or 0) tells
  /// which lanes have a beam; those whose direction is NaN lose it.
  void set_rays(const std::array<std::size_t, kLanes>& beam, const BeamBlock& in_sensor,
                Lanes<int>& valid, RayHits& rays) const;

  /// Asks the memory for what doubtful() needs of a lane's triangle.
  void prefetch(const HitBlock& block, unsigned lane) const {
    __builtin_prefetch(world_.narrowness(block.instance[lane], block.primitive[lane]));
  }

  /// The lanes of a block whose triangle the hair could have changed.
  [[nodiscard]] std::uint32_t doubtful(const HitBlock& block, const ExactBlock& exact,
                                       const RayHits& rays) const;

  /// The true beam's triangle, which may be the one found or another.
  [[nodiscard]] Found settle(std::size_t beam, const Found& found) const;

 private:
  [[nodiscard]] double hair_of(std::uint32_t instance) const;

  const World& world_;
  const TraceSpace& space_;
  const Resolver& resolver_;
  const ExactSearch& search_;
  const Beams& beams_;
  bool cull_back_faces_;
  double hair_;   ///< the offset, in units of the trace space
  double slack_;  ///< slack() there
};

}  // namespace glidar::embree
