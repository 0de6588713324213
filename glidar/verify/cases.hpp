// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>
#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glidar {

/// A ray that passes an edge nearer than this part of the shape's radius is not judged: renderers
/// search in float32 relative to a point near the shape, so that a vertex and a ray are each off by
/// a few of its roundings (2^-24 = 6e-8 of the radius); this is 32 of them.
inline constexpr double kEdgeTolerance = 2e-6;

/// One shape in one place, seen once.
struct VerifyCase {
  std::size_t shape = 0;        ///< index into make_shapes()
  double distance_m = 1.0;      ///< between the sensor and the sphere around the shape
  double radius_m = 0.5;        ///< of that sphere
  double offset_m = 0.0;        ///< of the shape from the world's zero
  bool offset_in_mesh = false;  ///< the offset is the mesh's origin, not the pose of the world
  std::uint32_t number = 0;     ///< of the case; decides attitudes and random rays
};

/// Every distance from 0.1 m to 10 km, offset and size at which one shape is looked at.
std::vector<VerifyCase> make_cases(std::size_t shape, double distance_m);

/// The distances, in metres.
const std::vector<double>& verify_distances();

/// Places the shape, casts a camera's rays and random ones, and judges them by the closed form.
VerifyResult run_case(const VerifyCase& verify_case, const Shape& shape,
                      const VerifySubject& subject);

}  // namespace glidar
