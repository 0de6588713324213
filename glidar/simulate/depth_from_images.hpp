// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>
#include <glidar/simulate/stereo_pixel_trace.hpp>
#include <glidar/simulate/tof_pixel_trace.hpp>

#include <variant>

namespace glidar {

/// The measurement of a depth camera by DepthModel::physical: renders the raw images of the frame,
/// and decodes range, intensity and status of every pixel from them. The frame has its
/// ground truth, which names the cause of holes.
void measure_depth(const Simulation& s);

/// How a pixel got its depth, by the type of the camera.
using DepthTrace = std::variant<StereoPixelTrace, TofPixelTrace>;

/// The trace of a pixel that measure_depth() measured last in this workspace.
DepthTrace trace_depth(const Simulation& s, std::size_t pixel);

}  // namespace glidar
