// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/renderer.hpp>
#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// Rays that pass an edge nearer than this fraction of the shape's radius are not compared.
/// Renderers may search in float32 relative to a point near the shape, so that vertices and rays
/// are off by a few roundings (2^-24 = 6e-8 of the radius); the tolerance is 32 roundings.
inline constexpr double kEdgeTolerance = 2e-6;

/// One shape at one position, measured from one pose.
struct VerifyCase {
  std::size_t shape = 0;        ///< index into make_shapes()
  double distance_m = 1.0;      ///< between the sensor and the sphere around the shape
  double radius_m = 0.5;        ///< of that sphere
  double offset_m = 0.0;        ///< of the shape from the world's origin
  bool offset_in_mesh = false;  ///< the offset is in the mesh's origin, not in the pose
  std::uint32_t number = 0;     ///< of the case; key of the attitudes and random rays
};

/// All offsets and sizes of one shape at this distance.
std::vector<VerifyCase> make_cases(std::size_t shape, double distance_m);

/// The distances of make_cases(), 0.1 m to 10 km.
const std::vector<double>& verify_distances();

/// Casts the rays of a camera and random rays at the shape, and compares the hits with the closed
/// form.
VerifyResult run_case(const VerifyCase& verify_case, const Shape& shape,
                      const VerifySubject& subject);

/// Beams with different firing times from a moving and rotating sensor, at a moving and a static
/// target. The exact hits follow the motion in extended precision.
VerifyResult moving_sensor_and_target(const VerifySubject& subject,
                                      const std::vector<Shape>& shapes);

/// Such beams among many bodies, most of which move.
VerifyResult sensor_in_traffic(const VerifySubject& subject, const std::vector<Shape>& shapes);

/// The beams at the target measured by a sensor: also the poses of sensor and target, the beams
/// without the motion, and radial velocities.
VerifyResult measured_motion(const VerifySubject& subject, const std::vector<Shape>& shapes);

}  // namespace glidar
