// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>

#include <vector>

namespace glidar {

struct Simulation;

/// The boxes of the objects of a frame that was simulated, in the order of the scene's instances;
/// objects without triangles, and those that the sensor does not see, have none. Which beams would
/// hit an object alone is decided by casts: of the beams that cross its box and hit another object
/// first, or nothing. Beams that hit it first need none. Objects and sensor move during the frame
/// as they do in the frame itself.
void find_boxes(const Simulation& s, BoxSelection selection, std::vector<ObjectBox>& boxes);

}  // namespace glidar
