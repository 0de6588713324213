// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/depth_trace.hpp>
#include <glidar/simulate/simulation.hpp>

namespace glidar {

/// The measurement of a depth camera by DepthModel::physical: renders the raw images of the frame,
/// and decodes range, intensity and status of every pixel from them. The frame has its
/// ground truth, which names the cause of holes.
void measure_depth(const Simulation& s);

/// The trace of a pixel that measure_depth() measured last in this workspace.
DepthTrace trace_depth(const Simulation& s, std::size_t pixel);

}  // namespace glidar
