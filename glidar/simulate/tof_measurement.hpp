// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>
#include <glidar/simulate/tof_pixel_trace.hpp>

namespace glidar {

/// Exposes the raw images of a time-of-flight camera and decodes them. See measure_depth().
void measure(const Simulation& s, const PreparedTof& prepared);

/// The trace of a pixel that measure() measured last in this workspace.
TofPixelTrace trace_pixel(const Simulation& s, const PreparedTof& prepared, std::size_t pixel);

}  // namespace glidar
