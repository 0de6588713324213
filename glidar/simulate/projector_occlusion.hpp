// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

namespace glidar {

/// Removes the returns of surfaces that the sensor's projector does not see: they become occluded.
/// Every hit is cast at once more from the projector, at its beam's firing time. Between a front
/// surface at depth z1 and one behind it at z2 the shadow is f b (1/z1 - 1/z2) pixels wide, with b
/// the distance between projector and camera. Needs normal in frame.ground_truth.
void occlude_from_projector(const Simulation& s, const Eigen::Vector3d& projector_origin_m);

}  // namespace glidar
