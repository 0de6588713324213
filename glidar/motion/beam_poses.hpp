// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/motion/motion.hpp>

namespace glidar {

/// If `wanted`, fills frame.beam_poses with the poses of the sensor and of the instance hit
/// (frame.ground_truth.instance) at each beam's firing time; else clears it.
void record_beam_poses(const Motion& motion, const Beams& beams, bool wanted,
                       ThreadPool& thread_pool, Frame& frame);

}  // namespace glidar
