// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/tof/tof_exposure.hpp>
#include <glidar/tof/tof_trace.hpp>

#include <vector>

namespace glidar {

/// How a pixel of a time-of-flight camera got its range or the cause of its hole.
struct TofPixelTrace {
  std::vector<TofLight> light = {};  ///< of each phase step, frequency by frequency
  double bounced_share = 0.0;        ///< of the modulated light, over diffuse bounces
  TofTrace decoded;
};

}  // namespace glidar
