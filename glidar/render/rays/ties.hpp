// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/primitive_ref.hpp>
#include <glidar/render/rays/scene_trees.hpp>

#include <cstddef>

namespace glidar::rays {

/// One cast, as every part of the search needs it.
struct CastView {
  const SceneTrees& trees;
  const Resolver& resolver;
  const CastRequest& request;
};

/// The distance at which a beam meets a triangle by the hit rule, metres; 0: it does not.
double hit_distance_m(const CastView& cast, std::size_t beam, const PrimitiveRef& triangle);

/// How much farther a triangle may be that ties with this one, metres: surfaces of two instances
/// that lie on each other are apart by the rounding of their coordinates, kTiePart / 2 of each
/// reach, measured across the one that the beam meets more steeply. `reach_m`: the sum of both
/// reaches, halved, or a bound of it.
double tie_window_m(const CastView& cast, std::size_t beam, const PrimitiveRef& triangle,
                    double reach_m);

/// How a triangle compares with another that the same beam hits, of another instance.
struct HitOrder {
  bool is_nearer;  ///< it is hit first
  bool ties;       ///< their distances differ, but by no more than tie_window_m()
};

HitOrder order_of_hits(const CastView& cast, std::size_t beam, const PrimitiveRef& found,
                       const PrimitiveRef& before);

/// The lowest instance and triangle of those that tie with the nearest one, see tie_window_m().
PrimitiveRef lowest_of_ties(const CastView& cast, std::size_t beam, const PrimitiveRef& nearest);

}  // namespace glidar::rays
