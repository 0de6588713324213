// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>

#include <vector>

namespace glidar::app {

/// The outputs of each sensor of the scene. On a rig, outputs that do not fit a sensor, such
/// as the depth image of a 360 degree LiDAR, are left out with a note. Throws Error if an output
/// fits none of the sensors.
std::vector<OutputFlags> outputs_by_sensor(const RenderFlags& flags, const PreparedScene& prepared,
                                           Console& console);

}  // namespace glidar::app
