// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/motion/motion.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// `motion` of a scene file. It starts at the pose that the file gives in another key.
struct MotionKeys {
  std::optional<Pose> start;  ///< at t0_ns; empty: the file gives none
  std::int64_t t0_ns = 0;
  std::optional<Trajectory> trajectory;  ///< empty: stationary
  std::vector<std::string> files;        ///< those that were read
};

/// {spin: ...}, {twist: ...} or {tumbling: ...} from the start, or {trajectory: ...}, which
/// contains the poses and is an error if there is a start.
void describe(MotionKeys& keys, FieldVisitor& visitor);

/// The pose from which a motion starts; of other trajectories the pose at time 0.
Pose start_pose(const Trajectory& trajectory);

/// A motion as a nested map. Returns whether it is present.
bool visit_motion(FieldVisitor& visitor, const FieldInfo& field, MotionKeys& keys);

/// The numbers of a spin, a twist or a torque-free rotation as a JSON text with the keys of
/// `motion` in scene files (docs/files/motion.md), without its start. parse_motion() makes the same
/// motion from it and the start, to the last bit. Throws Error for another kind of trajectory.
std::string motion_document(const Trajectory& trajectory);

/// The motion of a text, YAML or JSON, from its pose at t0. Errors name the field.
Trajectory parse_motion(const std::string& text, const Pose& start, std::int64_t t0_ns);

}  // namespace glidar
