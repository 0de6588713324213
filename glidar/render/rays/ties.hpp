// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/primitive_ref.hpp>
#include <glidar/render/rays/scene_trees.hpp>

#include <cstddef>

namespace glidar::rays {

/// One cast, as all parts of the search need it.
struct CastView {
  const SceneTrees& trees;
  const Resolver& resolver;
  const CastRequest& request;
};

/// The maximum of SceneTrees::reach_m().
double max_reach_m(const CastView& cast, const InstanceRange& instances);

/// The distance at which a beam meets a triangle by the hit rule, metres; 0: it does not.
double hit_distance_m(const CastView& cast, std::size_t beam, const PrimitiveRef& triangle);

/// Distance by which a triangle may be farther and still tie with this one, metres. Coincident
/// surfaces of two instances differ by the rounding of their coordinates, kTiePart / 2 of each
/// reach, measured across the one with the smaller angle of incidence. `reach_m`: half the sum of
/// both reaches, or an upper bound.
double tie_window_m(const CastView& cast, std::size_t beam, const PrimitiveRef& triangle,
                    double reach_m);

/// Order of a triangle and another one, of another instance, that the same beam hits.
struct HitOrder {
  bool is_nearer;  ///< it is hit first
  bool ties;       ///< lowest_of_ties() may report a triangle other than the one hit first
};

/// `reach_m`: at least half the sum of the reaches of any two instances that the search compared.
HitOrder order_of_hits(const CastView& cast, std::size_t beam, const PrimitiveRef& found,
                       const PrimitiveRef& before, double reach_m);

/// The same with the largest reach of the scene.
inline HitOrder order_of_hits(const CastView& cast, std::size_t beam, const PrimitiveRef& found,
                              const PrimitiveRef& before) {
  return order_of_hits(cast, beam, found, before, cast.trees.max_reach_m());
}

/// The lowest instance and triangle of those that tie with the nearest one, see tie_window_m(),
/// among the beam's targets.
PrimitiveRef lowest_of_ties(const CastView& cast, std::size_t beam, const PrimitiveRef& nearest);

}  // namespace glidar::rays
