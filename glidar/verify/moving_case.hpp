// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <vector>

namespace glidar {

/// Beams that leave one after the other from a sensor that turns and moves, at a target that does
/// too and at one at rest. The truth follows the motion in extended precision.
VerifyResult moving_sensor_and_target(const VerifySubject& subject,
                                      const std::vector<Shape>& shapes);

}  // namespace glidar
