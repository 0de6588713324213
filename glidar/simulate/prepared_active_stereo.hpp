// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/sensor/depth_camera/active_stereo.hpp>

#include <vector>

namespace glidar {

/// An active stereo camera with everything that is the same for all frames.
struct PreparedActiveStereo {
  const ActiveStereo& camera;
  PinholeIntrinsics intrinsics;
  double wavelength_m = 0.0;
  IntensityMap pattern;
  Beams rays;                       ///< sub_rays x sub_rays for each pixel, row by row
  std::vector<double> weights;      ///< of the rays around a pixel, see point_spread_weights()
  double electron_rate = 0.0;       ///< see electron_rate_per_radiance()
  std::vector<float> pattern_view;  ///< Reference::pattern: the pattern as the second camera
};

PreparedActiveStereo prepare_active_stereo(const ActiveStereo& camera,
                                           const PinholeIntrinsics& intrinsics,
                                           double wavelength_m);

}  // namespace glidar
