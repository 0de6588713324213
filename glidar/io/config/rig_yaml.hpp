// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/scene_builder.hpp>
#include <glidar/io/config/yaml_reader.hpp>

namespace glidar {

/// Reads the sensors of a scene file and their poses: `sensor`, `sensor_pose` and
/// `sensor_motion`, or `sensors`, `rig_pose` and `rig_motion`.
void read_rig(const YamlField& root, ScenePlan& plan);

}  // namespace glidar
