// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>
#include <glidar/simulate/structured_light_pixel_trace.hpp>

namespace glidar {

/// Takes the images of all patterns and decodes them. See measure_depth().
void measure(const Simulation& s, const PreparedStructuredLight& prepared);

/// The trace of a pixel that measure() measured last in this workspace.
StructuredLightPixelTrace trace_pixel(const Simulation& s, const PreparedStructuredLight& prepared,
                                      std::size_t pixel);

}  // namespace glidar
