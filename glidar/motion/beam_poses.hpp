// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/motion/motion.hpp>

namespace glidar {

/// When `wanted`, writes into frame.beam_poses where the sensor and the instance that
/// frame.ground_truth.instance names were when each beam left; else empties it.
void place_beams(const Motion& motion, const Beams& beams, bool wanted, ThreadPool& thread_pool,
                 Frame& frame);

}  // namespace glidar
