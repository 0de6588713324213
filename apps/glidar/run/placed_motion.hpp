// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/prepared_scene.hpp>
#include <glidar/link/lockstep/messages.hpp>

namespace glidar::app {

/// The motion of the rig and all instances from the state of a moment on. Without objects in it,
/// they move as prepared.
RigMotion motion_at(const lockstep::Moment& moment, const PreparedScene& prepared);

/// The bodies of a motion with a constant pose of the rig; without the objects if any of them
/// moves.
lockstep::Moment static_moment(const RigMotion& motion);

/// Whether a sensor and the instances of a motion with constant poses are within kMaxCoordinate_m;
/// what moves is not checked.
bool is_within_reach(const Motion& motion);

}  // namespace glidar::app
