// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace glidar {

/// The known failure of a renderer in a row's case; without a reason, the row must pass.
KnownFailure known_failure(const AccuracyCase& row);

/// A reported triangle must contain the exact point within this fraction of range and size: 2^12
/// roundings of double, for the point and for the beam's direction.
inline constexpr double kIdTolerance = 0x1p-40;

/// The columns that casts of verify() fill.
inline constexpr HitColumnMask kGeometricColumns = {.depth = true,
                                                    .normal = true,
                                                    .shading_normal = true,
                                                    .incidence = true,
                                                    .shading = true,
                                                    .barycentrics = true,
                                                    .object_point = true};

/// Bound of errors of columns in float32: unit vectors, cosines and barycentric weights.
inline constexpr double kColumnBound = 1e-6;

/// A shape as an instance of a scene, relative to a viewpoint.
struct PlacedShape {
  const Shape& shape;
  double scale;
  ExactPose pose;
  ClosedForm form;
};

PlacedShape place_shape(const Shape& shape, double scale, const ExactPose& pose);

/// The exact description of a scene: one shape per instance.
struct ExactScene {
  std::vector<PlacedShape> shapes;
  double edge_tolerance_m = 0.0;  ///< rays nearer to an edge or silhouette are not compared
  bool is_from_inside = false;    ///< the viewpoint is inside or on the only shape
};

/// The hit that a renderer reports for a beam, in world axes.
struct ReportedHit {
  std::uint32_t instance;
  std::uint32_t primitive;
  double range_m;
  RealVector normal;
};

/// The exact hit of a beam, relative to the viewpoint, in world axes.
struct ExactContact {
  std::uint32_t instance;
  Real range_m;
  RealVector point;
  double tolerance_m;  ///< rounding of the point
};

/// Compares a beam's hit with the exact one and adds the errors to `result`. The origin is relative
/// to the viewpoint. Returns the exact hit if the beam was compared and its ids are right.
std::optional<ExactContact> compare_beam(const ExactScene& scene, const RealVector& origin,
                                         const RealVector& direction, const ReportedHit& reported,
                                         VerifyResult& result);

/// Compares a cast of a static scene with kGeometricColumns. The viewpoint is the sensor's origin.
/// Of every `stride` beams one is compared.
VerifyResult compare_cast(const ExactScene& scene, const Pose& world_from_sensor,
                          const Beams& beams, const Hits& hits, ThreadPool& thread_pool,
                          std::size_t stride = 1);

}  // namespace glidar
