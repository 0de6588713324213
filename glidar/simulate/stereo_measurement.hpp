// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>
#include <glidar/simulate/stereo_pixel_trace.hpp>

namespace glidar {

/// Renders the infrared images of an active stereo camera and matches them. See measure_depth().
void measure(const Simulation& s, const PreparedActiveStereo& prepared);

/// Traces a pixel of the frame that measure() measured last in this workspace.
StereoPixelTrace trace_pixel(const Simulation& s, const PreparedActiveStereo& prepared,
                             std::size_t pixel);

}  // namespace glidar
