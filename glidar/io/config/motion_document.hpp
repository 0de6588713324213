// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>

#include <string>

namespace glidar {

/// The numbers of a spin, a twist or a torque-free rotation as a JSON text with the keys of
/// `motion` in scene files (docs/files/motion.md), without its start. parse_motion() makes the same
/// motion from it and the start, to the last bit. Throws Error for another kind of trajectory.
std::string motion_document(const Trajectory& trajectory);

/// The motion of a text, YAML or JSON, from its pose at t0. Errors name the field.
Trajectory parse_motion(const std::string& text, const Pose& start, std::int64_t t0_ns);

}  // namespace glidar
