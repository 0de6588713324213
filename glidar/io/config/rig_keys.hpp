// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/scene_plan.hpp>

#include <string>

namespace glidar {

/// The sensors of a scene file and where they are: `sensor`, `sensor_pose` and `sensor_motion`, or
/// `sensors`, `rig_pose` and `rig_motion`.
void visit_rig(FieldVisitor& visitor, ScenePlan& plan);

/// The key `name` of something on a rig. Returns its place in the file, for later errors.
std::string visit_rig_name(FieldVisitor& visitor, std::string& name);

}  // namespace glidar
