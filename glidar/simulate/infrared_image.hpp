// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

namespace glidar {

/// Electrons per second of each pixel of a camera with the sensor's optics at `origin_m` in the
/// sensor frame: rays into the scene, the light of projector, sun and surroundings that their
/// surfaces send back, shadows, point spread, and the fall of the light with cos^4 of the angle
/// from the axis.
void render_infrared(const Simulation& s, const PreparedActiveStereo& prepared,
                     const Eigen::Vector3d& origin_m, ElectronRates& rates);

}  // namespace glidar
