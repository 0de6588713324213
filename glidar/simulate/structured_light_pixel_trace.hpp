// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/depth_camera/imager.hpp>
#include <glidar/structured_light/fringe_trace.hpp>

#include <vector>

namespace glidar {

/// How a pixel of a structured-light camera got its depth or the cause of its hole.
struct StructuredLightPixelTrace {
  Exposure exposure;
  std::vector<double> electrons = {};  ///< of each image: the mean without noise
  double true_projector_px = 0.0;      ///< coordinate of the surface; NaN where it is not lit
  FringeTrace decoded = {};
};

}  // namespace glidar
