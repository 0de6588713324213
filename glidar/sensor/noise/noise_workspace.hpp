// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace glidar {

/// Memory that noise steps reuse from frame to frame. N = number of beams.
struct NoiseWorkspace {
  std::vector<double> before;    ///< N, ranges or depths as they were before a step
  std::vector<float> amplitude;  ///< N, intensities as they were before a step
};

}  // namespace glidar
