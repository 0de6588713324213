// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/prepared_imager.hpp>

#include <vector>

namespace glidar {

/// An active stereo camera with everything that is the same for all frames.
struct PreparedActiveStereo {
  const ActiveStereo& camera;
  PreparedImager imager;
  double focal_length_px = 0.0;  ///< along x
  IntensityMap pattern;
  std::vector<float> pattern_view;  ///< Reference::pattern: the pattern as the second camera
};

PreparedActiveStereo prepare_active_stereo(const ActiveStereo& camera, const Sensor& sensor);

}  // namespace glidar
