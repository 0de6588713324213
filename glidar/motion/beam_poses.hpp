// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/workers.hpp>
#include <glidar/motion/motion.hpp>

namespace glidar {

/// When `wanted`, writes into frame.beam_poses where the sensor and the instance that
/// frame.truth.instance names were when each beam left; else empties it.
void place_beams(const Motion& motion, const Beams& beams, bool wanted, Workers& workers,
                 Frame& frame);

}  // namespace glidar
