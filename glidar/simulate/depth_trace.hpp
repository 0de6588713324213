// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/stereo_pixel_trace.hpp>
#include <glidar/simulate/structured_light_pixel_trace.hpp>
#include <glidar/simulate/tof_pixel_trace.hpp>

#include <variant>

namespace glidar {

/// How a pixel got its depth, by the type of the camera.
using DepthTrace = std::variant<StereoPixelTrace, TofPixelTrace, StructuredLightPixelTrace>;

}  // namespace glidar
