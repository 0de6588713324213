// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// A reported triangle must hold the true point up to this part of range and size: 2^12 roundings
/// of double, for the point and for the beam's direction.
inline constexpr double kIdTolerance = 0x1p-40;

/// A shape as an instance of a scene, seen from a viewpoint.
struct PlacedShape {
  const Shape& shape;
  double scale;
  RealPlace place;
  ClosedForm form;
};

PlacedShape place_shape(const Shape& shape, double scale, const RealPlace& place);

/// All that beams may meet: one shape per instance of the scene.
struct TrueScene {
  std::vector<PlacedShape> shapes;
  double edge_tolerance_m = 0.0;  ///< rays that pass an edge or outline nearer are not judged
  bool is_from_inside = false;    ///< the viewpoint is in or on the only shape
};

/// What a renderer reported of a beam, in the scene's axes.
struct Reported {
  std::uint32_t instance;
  std::uint32_t primitive;
  double range_m;
  RealVector normal;
};

/// Adds what a beam shows. Origin relative to the viewpoint.
void judge_beam(const TrueScene& scene, const RealVector& origin, const RealVector& direction,
                const Reported& reported, VerifyResult& result);

/// Judges a cast at rest. The scene's viewpoint is the sensor's origin.
VerifyResult judge_cast(const TrueScene& scene, const Pose& world_from_sensor, const Beams& beams,
                        const Hits& hits);

}  // namespace glidar
