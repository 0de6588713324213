// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <vector>

namespace glidar {

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
