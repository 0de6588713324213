// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/session.hpp>
#include <glidar/link/lockstep/messages.hpp>

namespace glidar::app {

/// How the rig and all instances go on from where a moment places them; without objects these move
/// as in the session.
RigMotion motion_at(const lockstep::Moment& moment, const Session& session);

/// The bodies of a motion in which all stands still.
lockstep::Moment static_moment(const RigMotion& motion);

}  // namespace glidar::app
